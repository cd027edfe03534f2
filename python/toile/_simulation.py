"""Cloth and body in time."""

from __future__ import annotations

import os
import warnings
from copy import copy
from typing import Any, Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _toile
from ._body import Body
from ._cloth import Cloth, FabricLike, as_cloths, as_fabric
from ._errors import Error, InputError
from ._frame import Frame
from ._paths import Paths
from ._pictures import VIEW, ShowsItself
from ._progress import ProgressCall, Shown
from ._reads import Changing, Reads
from ._recipe import file_path
from ._toile import Crossings, DressReport, State, StepReport

Floats = NDArray[np.float64]
Integers = NDArray[np.int32]

_MOVES = ("positions_m", "velocities_m_per_s", "body_positions_m", "still")


def _particles(given: ArrayLike) -> Integers:
    return _arrays.integers(np.atleast_1d(np.asarray(given)), "particles", ("particles",))


class Simulation(ShowsItself):
    """Cloth on a body, or in the air.

    The same calls give the same bits, on any number of threads and in any process.  Arrays are read-only, and each is of the
    moment when it was read: it is copied once after the simulation has moved, is the same object until it moves again, and
    stays as it is whatever becomes of the simulation.  The GIL is free while a simulation works, and Ctrl-C ends its work
    with KeyboardInterrupt.  It is used by one thread at a time; two simulations may run in two threads.

    Every call raises Error, or InputError, for what cannot be meant, and has then changed nothing.  Physics that goes badly is
    in the reports.

    Pickles with the recipe of its cloth, body and options, and its state; a pattern or a body from a file is read again where
    it is unpickled, from the same path, and has to be the same.
    """

    def __init__(
        self,
        cloth: Cloth | Sequence[Cloth],
        fabric: FabricLike | None = None,
        body: Body | None = None,
        *,
        solids: Sequence[Body] = (),
        gravity_m_per_s2: ArrayLike = _toile.gravity_m_per_s2,
        wind_m_per_s: ArrayLike = (0, 0, 0),
        air_density_kg_per_m3: float = _toile.air_density_kg_per_m3,
        threads: int = 0,
    ) -> None:
        """Of one cloth, or of several that are worn together, the inner ones first.

        Cloth that is no pattern hangs at once where it starts; what begins through itself or the body is taken apart first.

        fabric                 of all panels without one of their own: a Fabric, or the name of a preset; None: the cloth's own
        body                   what it is worn by, or falls on; None: nothing
        solids                 what it collides with besides: they stand, or move by themselves
        gravity_m_per_s2       y is up
        wind_m_per_s           of the air around it
        air_density_kg_per_m3  0: cloth moves as in a vacuum
        threads                0: one per core
        """
        cloths = [copy(c) for c in as_cloths(cloth)]
        if fabric is not None:
            made_of = as_fabric(fabric)
            for one in cloths:
                one.set_fabric(made_of)
        if body is not None and not isinstance(body, Body):
            raise TypeError(f"body: expected a toile.Body or None, got {type(body).__name__}")
        for solid in solids:
            if not isinstance(solid, Body):
                raise TypeError(f"solids: expected toile.Body, got {type(solid).__name__}")
        self._begin(
            {
                "cloths": cloths,
                "body": Body.none() if body is None else copy(body),
                "solids": [copy(solid) for solid in solids],
                "gravity_m_per_s2": _arrays.point(gravity_m_per_s2, "gravity_m_per_s2"),
                "wind_m_per_s": _arrays.point(wind_m_per_s, "wind_m_per_s"),
                "air_density_kg_per_m3": float(air_density_kg_per_m3),
                "threads": threads,
            }
        )

    @classmethod
    def from_scene(cls, path: str | os.PathLike[str], *, threads: int = 0) -> Simulation:
        """What a scene file says (docs/scenes.md), in memory: no folder is made.  Raises IoError and InputError."""
        made = object.__new__(cls)
        made._begin({"scene": file_path(path), "threads": threads})
        return made

    def _begin(self, recipe: dict[str, Any]) -> None:
        if "scene" in recipe:
            self._core = _toile.Simulation.from_scene(recipe["scene"], recipe["threads"])
        else:
            own = {**recipe, "cloths": [c._core for c in recipe["cloths"]], "body": recipe["body"]._core}
            own["solids"] = [solid._core for solid in recipe["solids"]]
            self._core = _toile.Simulation(**own)
        self._recipe = recipe
        self._paths = Paths()
        self._read = Reads()

    # In time.

    def dress(
        self, longest_s: float = 20, time_limit_s: float = 0, *, progress: bool | ProgressCall | None = None
    ) -> DressReport:
        """Sews patterns around the body and lets them hang until they are at rest, or for longest_s of simulated time.

        Other cloth comes to rest.  time_limit_s is wall time, 0: any.  progress: True for a bar of text (by tqdm where it is
        installed), or what is called with phase, share of it (0 ... 1) and the seconds left of it or None.

        A garment that is not worn as it should be is no exception: look at DressReport.ok and .explain().  After a
        KeyboardInterrupt or an exception of `progress` the simulation is as it was before.
        """
        with Shown(progress) as call, self._changing():
            return self._core.dress(longest_s, time_limit_s, call)

    def run(self, *, progress: bool | ProgressCall | None = None) -> DressReport:
        """Of a scene: all that it says, to its end, as the program does."""
        with Shown(progress) as call, self._changing():
            return self._core.run(call)

    def advance(self, h_s: float) -> StepReport:
        """By exactly h_s (at most 10 s).  A body with a motion begins it at the first call.

        A step that could not be made is no exception: look at StepReport.ok and .explain().
        """
        report: StepReport | None = None
        with self._changing(*_MOVES):
            for end_s, part_s in self._paths.parts(self._core.time_s, h_s):
                for particles, to_m in self._paths.at(end_s):
                    self._core.move_pins(particles, to_m)
                part = self._core.advance(part_s)
                report = part if report is None else report.then(part)
                if not report.ok:
                    break
        assert report is not None
        return report

    def frames(self, seconds: float, fps: float = 30) -> Iterator[Frame]:
        """Advances by 1 / fps at a time, and yields a Frame after each.

        The last frame is the first that could not be simulated to its end, with a RuntimeWarning that says why, or the one at
        `seconds`.  Frames stay as they are; leaving the loop leaves the simulation at the frame that was yielded last.
        """
        if not fps > 0 or not seconds >= 0:
            raise InputError(f"seconds, fps: expected times that are not below zero, got {seconds} s at {fps} frames a second")
        for _ in range(round(seconds * fps)):
            step = self.advance(1 / fps)
            if not step.ok:
                warnings.warn(f"frames end at {self.time_s:.3f} s: {step.explain()}", RuntimeWarning, stacklevel=2)
            yield self.frame(step)
            if not step.ok:
                return

    def frame(self, step: StepReport | None = None) -> Frame:
        """This moment."""
        return Frame(
            t_s=self.time_s,
            positions_m=self.positions_m,
            velocities_m_per_s=self.velocities_m_per_s,
            body_positions_m=self.body_positions_m,
            step=step,
        )

    @property
    def time_s(self) -> float:
        """Since everything is on: after dress() it is how long the cloth hung."""
        return self._core.time_s

    def reset(self) -> None:
        """Takes everything back to how it was made."""
        with self._changing():
            self._core.reset()
            self._paths = Paths()

    def cancel(self) -> None:
        """Ends the call that is at work, from any thread: its report says so."""
        self._core.cancel()

    # What there is to see.

    @property
    def positions_m(self) -> Floats:
        """(n, 3) of the particles.  Before dress() of a pattern: its panels, unsewn."""
        return self._seen("positions_m")

    @property
    def velocities_m_per_s(self) -> Floats:
        """(n, 3) of the particles."""
        return self._seen("velocities_m_per_s")

    @property
    def faces(self) -> Integers:
        """(f, 3) particles, counter-clockwise seen from the right side."""
        return self._seen("faces")

    @property
    def uv_m(self) -> Floats:
        """(f, 3, 2) of the corners of the faces: how it was cut."""
        return self._seen("uv_m")

    @property
    def panel(self) -> Integers:
        """(f,) of the faces: a place in panel_names."""
        return self._seen("panel")

    @property
    def warnings(self) -> list[str]:
        """What of the files was not taken as it stands, and what is probably not meant."""
        return self._core.warnings()

    @property
    def panel_names(self) -> list[str]:
        return self._core.panel_names()

    @property
    def body_positions_m(self) -> Floats:
        """(b, 3) of the vertices of the body and the solids, in this order; (0, 3) without any."""
        return self._seen("body_positions_m")

    @property
    def body_faces(self) -> Integers:
        """(g, 3) of the body and the solids."""
        return self._seen("body_faces")

    @property
    def colliders(self) -> int:
        """How many there are: the body, if there is one, and the solids."""
        return self._core.collider_count()

    def collider_positions_m(self, collider: int) -> Floats:
        """(c, 3) of the vertices of one: 0 is the body, or the first solid where there is none.  Raises InputError."""
        return self._core.collider_positions_m(collider)

    def picture(
        self, *, width: int = 480, height: int = 480, azimuth_deg: float = 25, elevation_deg: float = 10, samples: int = 8
    ) -> bytes:
        """A PNG of cloth and bodies as they are now, the cloth filling it: what a notebook shows of a simulation.

        azimuth_deg  where it is seen from: 0 is the front (+z), 90 its left side (+x), 180 the back
        samples      paths per pixel: 8 do, 24 are smooth

        Raises Error where Toile was built without pictures.
        """
        return _toile.picture_of_simulation(self._core, width, height, azimuth_deg, elevation_deg, samples)

    def _still(self) -> bytes:
        return self._read.once("still", lambda: _toile.picture_of_simulation(self._core, **VIEW))

    def crossings(self) -> Crossings:
        """How many edges pass through a triangle, by exact tests."""
        return self._core.crossings()

    # Hands on it.

    def pin(self, particles: ArrayLike, path_m: ArrayLike | None = None, *, fps: float | None = None) -> None:
        """Holds particles where they are, until they are released.

        path_m: (samples, particles, 3), `fps` of them in a second, the first of now: the particles go there, straight from
        sample to sample, and stay at the last one.  A path is the simulation's, not the state's: see set_state.
        """
        held = _particles(particles)
        if (path_m is None) != (fps is None):
            raise TypeError("pin: path_m and fps belong together")
        path = None if path_m is None else _arrays.own(_arrays.numbers(path_m, "path_m", ("samples", len(held), 3)))
        if path is not None and (not len(path) or not np.isfinite(path).all() or not fps or not 0 < fps < float("inf")):
            raise InputError("path_m, fps: expected at least one sample, finite, and an fps above zero")
        self._core.pin(held)
        self._paths.drop(held)
        if path is not None and fps is not None:
            self._paths.add(held, path, fps, self._core.time_s)

    def attach(self, particles: ArrayLike) -> None:
        """Holds particles where they are on the body or a solid: each is carried by the nearest point of its surface, and turns
        with it, until it is released.  Raises Error where there is nothing to hold on to.
        """
        held = _particles(particles)
        self._core.attach(held)
        self._paths.drop(held)

    def move_pins(self, particles: ArrayLike, to_m: ArrayLike) -> None:
        """Where pinned particles shall be at the end of the next advance(), each on a straight way; there they stay.

        to_m: (particles, 3).  It takes them off a path.
        """
        held = _particles(particles)
        self._core.move_pins(held, _arrays.numbers(to_m, "to_m", (len(held), 3)))
        self._paths.drop(held)

    def release(self, particles: ArrayLike) -> None:
        """Lets particles go."""
        free = _particles(particles)
        self._core.release(free)
        self._paths.drop(free)

    @property
    def pinned(self) -> list[int]:
        """The particles that are held, ascending."""
        return self._core.pinned()

    def grab(
        self,
        face: int | None = None,
        barycentric: ArrayLike = (1, 0, 0),
        *,
        particle: int | None = None,
        **grip: float,
    ) -> int:
        """A hand that pulls a point of the cloth by a spring; it begins where the point is.  Returns its number.

        The point is on a face, by the weights of its corners, or it is a particle.  The spring: stiffness_N_per_m,
        damping_N_s_per_m, max_force_N (docs/units.md).
        """
        if (face is None) == (particle is None):
            raise TypeError("grab: expected a face, or a particle=")
        weights = _arrays.point(barycentric, "barycentric")
        if particle is not None:
            places = np.argwhere(self.faces == particle)
            if not len(places):
                raise InputError(f"particle: expected one of a face, 0 to {len(self.positions_m) - 1}, got {particle}")
            face, corner = (int(k) for k in places[0])
            weights = tuple(float(k == corner) for k in range(3))  # type: ignore[assignment]
        assert face is not None
        return self._core.grab(face, weights, **grip)

    def drag(self, hand: int, to_m: ArrayLike) -> None:
        """Where the hand shall be at the end of the next advance(), on a straight way."""
        self._core.drag(hand, _arrays.point(to_m, "to_m"))

    def let_go(self, hand: int) -> None:
        self._core.let_go(hand)

    def set_body(self, vertices_m: ArrayLike) -> None:
        """Where a body without a motion shall be at the end of the next advance(), each vertex (b, 3) on a straight way."""
        self.set_collider(0, vertices_m)

    def set_collider(self, collider: int, vertices_m: ArrayLike) -> None:
        """The same of a solid; 0 is the body, or the first solid where there is none."""
        vertices = len(self.collider_positions_m(collider))
        self._core.set_collider(collider, _arrays.numbers(vertices_m, "vertices_m", (vertices, 3)))

    def set_friction(self, friction: float, *, collider: int = 0) -> None:
        """Of cloth on a collider (as in set_collider), from now on."""
        self._core.set_friction(collider, friction)

    def set_stiffness(self, *, panel: int = 0, stretch: float = 1, shear: float = 1, bend: float = 1) -> None:
        """How stiff a panel is, as shares of its fabric, from now on; damping in the same shares.  Raises InputError."""
        self._core.set_stiffness(panel, stretch, shear, bend)

    def set_pressure(self, Pa: float, *, panel: int = 0) -> None:
        """On a panel's right side, from now on (Cloth.set_panel_pressure).  Raises InputError."""
        self._core.set_pressure(panel, Pa)

    def set_gravity(self, m_per_s2: ArrayLike) -> None:
        """From now on."""
        self._core.set_gravity(_arrays.point(m_per_s2, "m_per_s2"))

    def set_wind(self, m_per_s: ArrayLike) -> None:
        """From now on; without air (air_density_kg_per_m3 = 0) there is none."""
        self._core.set_wind(_arrays.point(m_per_s, "m_per_s"))

    # Where it goes on from.

    def state(self) -> State:
        """All that decides how it goes on."""
        return self._core.state()

    def set_state(self, state: State) -> None:
        """Goes on from there with the same bits: a state of this simulation, or of another one that was made of the same cloth,
        body and options, dressed or not, in any process.  InputError for any other, or one that is not whole.

        Pins that follow a path go on with it at the state's time if the state holds them and is not older than the path.
        """
        with self._changing():
            self._core.set_state(state)
            self._paths.keep(self._core.pinned(), self._core.time_s)

    @property
    def state_hash(self) -> str:
        """Of the bits of all positions and velocities: 16 hexadecimal digits, as in report.json."""
        return self._core.state_hash()

    def __getstate__(self) -> dict[str, Any]:
        time_s = self._core.time_s  # it is not at work
        try:
            state = self._core.state()
        except Error as error:
            if error.code != "usage" or time_s > 0:
                raise
            state = None  # nothing is on yet
        return {"recipe": self._recipe, "state": state, "paths": self._paths}

    def __setstate__(self, kept: dict[str, Any]) -> None:
        self._begin(kept["recipe"])
        if kept["state"] is not None:
            self._core.set_state(kept["state"])
        self._paths = kept["paths"]

    def __repr__(self) -> str:
        return f"<Simulation of {len(self.positions_m)} particles at {self.time_s:.3f} s>"

    def _seen(self, what: str) -> NDArray[Any]:
        return self._read.once(what, getattr(self._core, what))

    def _changing(self, *what: str) -> Changing:
        return self._read.changing(what)

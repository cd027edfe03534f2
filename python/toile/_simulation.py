"""The simulation of cloth on a body."""

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

    The same calls give the same bits, on any number of threads and in any process.  Arrays are read-only snapshots: each is
    copied once after the simulation has moved, is the same object until it moves again, and never changes afterwards.  The
    GIL is released while a simulation works, and Ctrl-C ends its work with KeyboardInterrupt.  A simulation may be used by
    one thread at a time; two simulations may run in two threads.

    Every call raises Error, or InputError, for invalid input, and has then changed nothing.  A simulation that fails says so
    in its reports.

    Pickles with the recipe of its cloth, body and options, and its state; a pattern or a body from a file is read again from
    the same path when it is unpickled, and has to be the same.
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
        """One cloth, or several that are worn together, the inner ones first.

        Cloth that is no pattern hangs at once where it starts; intersections at the start are resolved first.

        fabric                 of all panels without one of their own: a Fabric, or the name of a preset; None: the cloth's own
        body                   the worn body, or one to fall on; None: no body
        solids                 further colliders: they stand, or move by themselves
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
        """The simulation of a scene file (docs/scenes.md), in memory: no folder is made.  Raises IoError and InputError."""
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

    # Advancing time.

    def dress(
        self, longest_s: float = 20, time_limit_s: float = 0, *, progress: bool | ProgressCall | None = None
    ) -> DressReport:
        """Sews patterns around the body and lets them hang until they are at rest, or for longest_s of simulated time.

        Other cloth only comes to rest.  time_limit_s is wall time, 0: no limit.  progress: True for a bar of text (by tqdm if it
        is installed), or a callable that gets the phase, its share done (0 ... 1) and its seconds left or None.

        A garment that is not worn as it should be raises no exception: see DressReport.ok and .explain().  After a
        KeyboardInterrupt or an exception of `progress` the simulation is as it was before.
        """
        with Shown(progress) as call, self._changing():
            return self._core.dress(longest_s, time_limit_s, call)

    def run(self, *, progress: bool | ProgressCall | None = None) -> DressReport:
        """Runs a scene to its end, as the program does."""
        with Shown(progress) as call, self._changing():
            return self._core.run(call)

    def advance(self, h_s: float) -> StepReport:
        """Advances by exactly h_s (at most 10 s).  A body with a motion begins it at the first call.

        A failed step raises no exception: see StepReport.ok and .explain().
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

        The last frame is the one at `seconds`, or the first that could not be simulated to its end, with a RuntimeWarning that
        says why.  Frames do not change; leaving the loop leaves the simulation at the frame that was yielded last.
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
        """The present state as a Frame."""
        return Frame(
            t_s=self.time_s,
            positions_m=self.positions_m,
            velocities_m_per_s=self.velocities_m_per_s,
            body_positions_m=self.body_positions_m,
            step=step,
        )

    @property
    def time_s(self) -> float:
        """Time since all garments are on: after dress() it is how long the cloth hung."""
        return self._core.time_s

    def reset(self) -> None:
        """Back to the state after construction."""
        with self._changing():
            self._core.reset()
            self._paths = Paths()

    def cancel(self) -> None:
        """Ends the running call, from any thread; its report says so."""
        self._core.cancel()

    # Reading the state.

    @property
    def positions_m(self) -> Floats:
        """(n, 3) of the particles.  Before dress() of a pattern: its unsewn panels."""
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
        """(f, 3, 2) of the corners of the faces: the rest shape."""
        return self._seen("uv_m")

    @property
    def panel(self) -> Integers:
        """(f,) of the faces: an index into panel_names."""
        return self._seen("panel")

    @property
    def warnings(self) -> list[str]:
        """Repairs of the input files, and input that is probably not meant."""
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
        """The number of colliders: the body, if there is one, and the solids."""
        return self._core.collider_count()

    def collider_positions_m(self, collider: int) -> Floats:
        """(c, 3) of the vertices of one: 0 is the body, or the first solid where there is none.  Raises InputError."""
        return self._core.collider_positions_m(collider)

    def picture(
        self, *, width: int = 480, height: int = 480, azimuth_deg: float = 25, elevation_deg: float = 10, samples: int = 8
    ) -> bytes:
        """A PNG of the present cloth and bodies, framed on the cloth, as a notebook shows it.

        azimuth_deg  the view: 0 from the front (+z), 90 from its left side (+x), 180 from the back
        samples      paths per pixel: 8 are enough, 24 are smooth

        Raises Error where Toile was built without pictures.
        """
        return _toile.picture_of_simulation(self._core, width, height, azimuth_deg, elevation_deg, samples)

    def _still(self) -> bytes:
        return self._read.once("still", lambda: _toile.picture_of_simulation(self._core, **VIEW))

    def crossings(self) -> Crossings:
        """The number of edges that pass through a triangle, by exact tests."""
        return self._core.crossings()

    # Pins, hands and changes.

    def pin(self, particles: ArrayLike, path_m: ArrayLike | None = None, *, fps: float | None = None) -> None:
        """Holds particles where they are, until they are released.

        path_m: (samples, particles, 3), `fps` of them in a second, the first for the present time: the particles go in straight
        lines from sample to sample, and stay at the last one.  A path belongs to the simulation, not to its state: see set_state.
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
        with it, until it is released.  Raises Error if there is no collider.
        """
        held = _particles(particles)
        self._core.attach(held)
        self._paths.drop(held)

    def move_pins(self, particles: ArrayLike, to_m: ArrayLike) -> None:
        """Moves pinned particles in a straight line to these points during the next advance(); they stay there.

        to_m: (particles, 3).  It ends their paths.
        """
        held = _particles(particles)
        self._core.move_pins(held, _arrays.numbers(to_m, "to_m", (len(held), 3)))
        self._paths.drop(held)

    def release(self, particles: ArrayLike) -> None:
        """Releases particles."""
        free = _particles(particles)
        self._core.release(free)
        self._paths.drop(free)

    @property
    def pinned(self) -> list[int]:
        """The pinned particles, ascending."""
        return self._core.pinned()

    def grab(
        self,
        face: int | None = None,
        barycentric: ArrayLike = (1, 0, 0),
        *,
        particle: int | None = None,
        **grip: float,
    ) -> int:
        """A hand that pulls a point of the cloth by a spring; it begins at that point.  Returns its number.

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
        """Moves the hand there in a straight line during the next advance()."""
        self._core.drag(hand, _arrays.point(to_m, "to_m"))

    def let_go(self, hand: int) -> None:
        self._core.let_go(hand)

    def set_body(self, vertices_m: ArrayLike) -> None:
        """Moves a body without a motion there during the next advance(), each vertex (b, 3) in a straight line."""
        self.set_collider(0, vertices_m)

    def set_collider(self, collider: int, vertices_m: ArrayLike) -> None:
        """The same for a solid; 0 is the body, or the first solid if there is none."""
        vertices = len(self.collider_positions_m(collider))
        self._core.set_collider(collider, _arrays.numbers(vertices_m, "vertices_m", (vertices, 3)))

    def set_friction(self, friction: float, *, collider: int = 0) -> None:
        """Friction of cloth on a collider (as in set_collider), from now on."""
        self._core.set_friction(collider, friction)

    def set_stiffness(self, *, panel: int = 0, stretch: float = 1, shear: float = 1, bend: float = 1) -> None:
        """Factors on a panel's stiffness and damping, relative to its fabric, from now on.  Raises InputError."""
        self._core.set_stiffness(panel, stretch, shear, bend)

    def set_pressure(self, Pa: float, *, panel: int = 0) -> None:
        """The pressure of a panel from now on (Cloth.set_panel_pressure).  Raises InputError."""
        self._core.set_pressure(panel, Pa)

    def set_gravity(self, m_per_s2: ArrayLike) -> None:
        """From now on."""
        self._core.set_gravity(_arrays.point(m_per_s2, "m_per_s2"))

    def set_wind(self, m_per_s: ArrayLike) -> None:
        """From now on; without air (air_density_kg_per_m3 = 0) there is none."""
        self._core.set_wind(_arrays.point(m_per_s, "m_per_s"))

    # Saving and restoring.

    def state(self) -> State:
        """The complete state: all that decides how it goes on."""
        return self._core.state()

    def set_state(self, state: State) -> None:
        """Restores a state of this simulation, or of another of the same cloth, body and options, dressed or not, in any process;
        it goes on with the same bits.  InputError for any other state, or an incomplete one.

        Pins on a path continue it at the state's time if they are pinned in the state and it is not older than the path.
        """
        with self._changing():
            self._core.set_state(state)
            self._paths.keep(self._core.pinned(), self._core.time_s)

    @property
    def state_hash(self) -> str:
        """Hash of the bits of all positions and velocities: 16 hexadecimal digits, as in report.json."""
        return self._core.state_hash()

    def __getstate__(self) -> dict[str, Any]:
        time_s = self._core.time_s  # raises if a call is running
        try:
            state = self._core.state()
        except Error as error:
            if error.code != "usage" or time_s > 0:
                raise
            state = None  # no garment is on yet
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

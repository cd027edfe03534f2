"""Colliders: a person, or another closed surface, that may move.

Garments are dressed on one body of a simulation, the worn body.  All others are solids, beside it.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from numpy.typing import ArrayLike

from . import _arrays, _toile
from ._errors import InputError
from ._recipe import Made, file_path


def _motion(given: str | os.PathLike[str]) -> str:
    name = os.fspath(given)
    return name if not name or name in Body.motion_names() else file_path(name)


class Body(Made):
    """A closed surface.  Made by one of the class methods below.

    Pickles as its recipe: arrays with their contents, a file with its path.
    """

    _core_type = _toile.Body

    def __init__(self) -> None:
        raise TypeError(
            "a Body is made by Body.mannequin, from_file, from_arrays, from_frames, cylinder, sphere, box, capsule, revolved or none"
        )

    @classmethod
    def none(cls) -> Body:
        """No body: cloth hangs in the air."""
        return cls._make("none")

    @classmethod
    def mannequin(cls, who: str, *, motion: str | os.PathLike[str] = "") -> Body:
        """One of the program's own: "woman", "man" or "dancer" (docs/mannequin.md).

        motion: one of motion_names(), a .pc2, .mdd or .bvh file or a folder of numbered mesh files; empty: it stands.
        """
        return cls._make("mannequin", who=who, motion=_motion(motion))

    @staticmethod
    def motion_names() -> list[str]:
        """The names of the mannequins' motions (docs/motions.md)."""
        return _toile.Body.motion_names()

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        unit: str = "automatic",
        motion: str | os.PathLike[str] = "",
        fps: float = 30,
        measurements: str | os.PathLike[str] = "",
        up: str = "automatic",
        clip: str | int = "",
        bones: str | os.PathLike[str] = "",
        rig: str | os.PathLike[str] = "",
        weights: str | os.PathLike[str] = "",
        targets: Mapping[str | os.PathLike[str], float] | None = None,
    ) -> Body:
        """A closed mesh (OBJ, PLY, STL, glTF); as a solid an open sheet, too.  It is read by the constructor of a simulation, which raises IoError and InputError.

        unit          "automatic" (metres, or an error that says which unit would fit), "m", "dm", "cm", "mm" or "in"
        motion        a .pc2 or .mdd file, a folder of numbered mesh files, or the name of a motion for upright meshes; of a body with a skeleton a
                      glTF or a BVH file; empty: it stands
        fps           frames a second of the motion's files
        measurements  a YAML file (docs/howto/measurements.md); empty: the one beside the mesh, if there is one
        clip          of a glTF motion: the name of an animation, or its number from 0; empty: the only one
        bones         of a BVH motion: a JSON file that says which joints are which part of a person (docs/motions.md); empty: by their names
        rig, weights  of a mesh without a skeleton: MakeHuman's, JSON; weights empty: the file beside the rig
        targets       changes of the mesh's shape, MakeHuman's: {file: share}, in this order, before anything else
        up            the axis of the file that points up: "y", "z", or "automatic", as a person is seen to stand in it; of a solid y
        """
        return cls._make(
            "from_file",
            path=file_path(path),
            unit=unit,
            motion=_motion(motion),
            fps=fps,
            measurements=file_path(measurements) if os.fspath(measurements) else "",
            up=up,
            clip=str(clip),
            bones=file_path(bones) if os.fspath(bones) else "",
            rig=file_path(rig) if os.fspath(rig) else "",
            weights=file_path(weights) if os.fspath(weights) else "",
            targets=[(file_path(file), float(share)) for file, share in (targets or {}).items()],
        )

    @classmethod
    def from_arrays(cls, vertices_m: ArrayLike, faces: ArrayLike) -> Body:
        """A closed mesh: vertices_m (n, 3) in metres, faces (f, 3) counter-clockwise from outside.  Arrays are copied.

        It stands, or goes where Simulation.set_body says.  Raises InputError for shapes other than these, and when a simulation
        is made with a surface that is not closed.
        """
        return cls._make(
            "from_arrays",
            vertices_m=_arrays.own(_arrays.numbers(vertices_m, "vertices_m", ("vertices", 3))),
            faces=_arrays.own(_arrays.integers(faces, "faces", ("faces", 3))),
        )

    @classmethod
    def from_frames(cls, frames_m: ArrayLike, faces: ArrayLike, *, fps: float) -> Body:
        """The same in motion: frames_m (frames, n, 3), `fps` of them in a second; it starts at the first.

        The motion begins at the first advance(); at its end the body stays.
        """
        return cls._make(
            "from_frames",
            frames_m=_arrays.own(_arrays.numbers(frames_m, "frames_m", ("frames", "vertices", 3))),
            faces=_arrays.own(_arrays.integers(faces, "faces", ("faces", 3))),
            fps=fps,
        )

    @classmethod
    def cylinder(cls, *, radius_m: float = 0.2, height_m: float = 0.5, top_m: ArrayLike = (0, 0, 0)) -> Body:
        """Upright, with rounded rims; top_m is the middle of its top."""
        return cls._make("cylinder", radius_m=radius_m, height_m=height_m, top_m=_arrays.point(top_m, "top_m"))

    @classmethod
    def sphere(cls, radius_m: float, *, edge_m: float = 0.02) -> Body:
        """Around the origin; edges of its triangles are at most edge_m long."""
        return cls._make("sphere", radius_m=radius_m, edge_m=edge_m)

    @classmethod
    def capsule(cls, radius_m: float, from_m: ArrayLike, to_m: ArrayLike, *, edge_m: float = 0.02) -> Body:
        """A rod with round ends, centred at from_m and to_m.  Equal ends raise InputError when a simulation is made."""
        ends = {"from_m": _arrays.point(from_m, "from_m"), "to_m": _arrays.point(to_m, "to_m")}
        return cls._make("capsule", radius_m=radius_m, **ends, edge_m=edge_m)

    @classmethod
    def box(cls, size_m: ArrayLike) -> Body:
        """Around the origin: size_m along x, y and z."""
        return cls._make("box", size_m=_arrays.point(size_m, "size_m"))

    @classmethod
    def revolved(cls, profile_m: ArrayLike, *, edge_m: float = 0.02) -> Body:
        """A surface of revolution about the y axis: profile_m (n, 2), distance from the axis and height, in metres.

        From the axis to the axis, or a closed curve beside it.  Any other profile raises InputError when a simulation is made.
        """
        outline = _arrays.numbers(profile_m, "profile_m", ("points", 2))
        return cls._make("revolved", profile_m=[(float(r), float(y)) for r, y in outline], edge_m=edge_m)

    def place(self, translation_m: ArrayLike = (0, 0, 0), *, rotation_deg: ArrayLike = (0, 0, 0)) -> Body:
        """Places a solid: rotated first (R = Rz Ry Rx), then shifted."""
        return self._change(
            "place",
            translation_m=_arrays.point(translation_m, "translation_m"),
            rotation_deg=_arrays.point(rotation_deg, "rotation_deg"),
        )

    def set_moves(self, keys: Iterable[Mapping[str, Any]]) -> Body:
        """Moves a solid from the first advance() on, relative to its own place, linearly between keys.

        A key is a mapping: t_s (ascending), and shift_m, rotation_deg and scale; one that is left out is as in the key before.
        Raises InputError for other names, or times that do not ascend.
        """
        path: list[tuple[float, Any, Any, float]] = []
        shift, turned, scale = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0
        for key in keys:
            unknown = set(key) - {"t_s", "shift_m", "rotation_deg", "scale"}
            if unknown or "t_s" not in key:
                raise InputError(f"keys: expected t_s, shift_m, rotation_deg and scale, got {sorted(key)}")
            shift = _arrays.point(key.get("shift_m", shift), "shift_m")
            turned = _arrays.point(key.get("rotation_deg", turned), "rotation_deg")
            scale = float(key.get("scale", scale))
            path.append((float(key["t_s"]), shift, turned, scale))
        return self._change("set_moves", keys=path)

    def set_inside_out(self, inside_out: bool = True) -> Body:
        """A solid seen from inside: a room."""
        return self._change("set_inside_out", inside_out=inside_out)

    def set_friction(self, friction: float) -> Body:
        """Friction of cloth on it.  Default: for a solid, the worn body's; for that one, the fabric's."""
        return self._change("set_friction", friction=friction)

    def set_offset(self, offset_m: float) -> Body:
        """The distance at which cloth rests on it.  Default: for a solid, the worn body's; for that one, by the cloth's edge length."""
        return self._change("set_offset", offset_m=offset_m)

    def __repr__(self) -> str:
        how, arguments = self._calls[0]
        return f"<Body {how} {arguments.get('path') or arguments.get('who') or ''}>".replace(" >", ">")

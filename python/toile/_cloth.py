"""A garment or a piece of cloth, before the simulation; and its fabric."""

from __future__ import annotations

import os
from typing import Any, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays, _toile
from ._recipe import Made, file_path
from ._toile import Fabric

FabricLike = Union[Fabric, str]


def fabric(name: str, **changes: Any) -> Fabric:
    """The preset of that name ("silk", "cotton", "poplin", ...: `fabric_names`), with some fields changed.

    Raises InputError, with the nearest name, for a name that fabric_names() has not, and TypeError for a field that
    Fabric has not.  Sources of the presets: docs/theory/fabrics.md.
    """
    return _toile.fabric(name).replace(**changes)


def as_fabric(given: FabricLike) -> Fabric:
    if isinstance(given, Fabric):
        return given
    if isinstance(given, str):
        return _toile.fabric(given)
    raise TypeError(f"fabric: expected a toile.Fabric or the name of one, got {type(given).__name__}")


class Cloth(Made):
    """A triangle mesh in space with its rest shape, and the fabric of each panel.

    Changes (`set_...`, `place`) return the cloth itself, so that calls can be chained.  A simulation copies it.
    Pickles as its recipe: arrays with their contents, a pattern with the path of its file.
    """

    _core_type = _toile.Cloth

    def __init__(
        self,
        vertices_m: ArrayLike,
        faces: ArrayLike,
        *,
        uv_m: ArrayLike | None = None,
        panel: ArrayLike | None = None,
        panel_names: Sequence[str] | None = None,
        name: str | None = None,
    ) -> None:
        """Cloth from arrays, which are copied.

        vertices_m   (n, 3) where it starts, m
        faces        (f, 3) integers, counter-clockwise seen from the right side
        uv_m         the rest shape, m, u along the warp: (f, 3, 2) of the corners of each face, which may differ on both
                     sides of a seam; or (n, 2) of the vertices.  None: the shape at the start
        panel        (f,) the number of each face's panel; None: it is one panel
        panel_names  their names; None: "panel_0", "panel_1" ... or, of one panel, the cloth's name

        Raises InputError for faces that are out of range, degenerate or not a surface, for numbers that are not finite and
        for shapes other than these, and TypeError for arrays of anything but numbers.
        """
        vertices = _arrays.own(_arrays.numbers(vertices_m, "vertices_m", ("vertices", 3)))
        corners = _arrays.own(_arrays.integers(faces, "faces", ("faces", 3)))
        uv = None
        if uv_m is not None:
            uv = _arrays.numbers(uv_m, "uv_m", (len(corners), 3, 2), (len(vertices), 2))
            if uv.ndim == 2:
                in_range = not corners.size or (corners.min() >= 0 and corners.max() < len(vertices))
                uv = uv[corners] if in_range else None  # the library names the face that is not
            uv = None if uv is None else _arrays.own(np.ascontiguousarray(uv))
        numbers = None if panel is None else _arrays.own(_arrays.integers(panel, "panel", (len(corners),)))
        if panel_names is None:
            count = 0 if numbers is None or not numbers.size else int(numbers.max()) + 1
            panel_names = [f"panel_{k}" for k in range(count)] if count > 1 else []
        elif isinstance(panel_names, str):
            raise TypeError("panel_names: expected a list of names, got one string")
        self._begin("from_arrays", vertices_m=vertices, faces=corners, uv_m=uv, panel=numbers, panel_names=list(panel_names))
        if name is not None:
            self.set_name(name)

    @classmethod
    def from_pattern(
        cls,
        path: str | os.PathLike[str],
        *,
        edge_m: float = 0.01,
        hem_m: float = 0.0,
        tape_m: float = 0.01,
        allowance_m: float = 0.0,
        topstitched: bool = False,
    ) -> Cloth:
        """The panels of a sewing pattern (GarmentCode's JSON), which Simulation.dress() sews around the body.

        edge_m: length of the triangles' edges.  hem_m, tape_m, allowance_m: widths, where the file says nothing, of a hem on open edges,
        of a tape on those with a label (waists, collars, armholes), and of the allowances on sewn edges; 0 is none.  topstitched: these
        allowances are stitched down, and seams bend as a bundle.  The file is read when a simulation is made of it, which
        raises IoError where it cannot be read and InputError where it is no such pattern (check_pattern() tells all that is wrong with it).
        """
        return cls._make("from_pattern", path=file_path(path), edge_m=edge_m, hem_m=hem_m, tape_m=tape_m, allowance_m=allowance_m, topstitched=topstitched)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], *, unit: str = "m", rest_shape: str = "automatic") -> Cloth:
        """A garment that is a mesh already (OBJ, PLY, STL, glTF): worn where it lies, not sewn.

        Its groups are its panels; vertices that the file had to split along a texture seam are one particle.  Repairs of the file
        are in Simulation.warnings.

        unit        of its coordinates: "m", "dm" or "cm"
        rest_shape  "drawing": its vt, in metres; "start": its shape at the start, with the warp by vt;
                    "automatic": the drawing, if it is in metres

        The file is read by the constructor of a simulation, which raises IoError or InputError.
        """
        return cls._make("from_file", path=file_path(path), unit=unit, rest_shape=rest_shape)

    @classmethod
    def grid(cls, *, width_m: float = 1, height_m: float = 1, edge_m: float = 0.02) -> Cloth:
        """A rectangle, upright in the plane z = 0, facing +z, centred at the origin."""
        return cls._make("grid", width_m=width_m, height_m=height_m, edge_m=edge_m)

    def set_name(self, name: str) -> Cloth:
        """Sets the name that messages and reports use."""
        return self._change("set_name", name=name)

    def set_fabric(self, fabric: FabricLike) -> Cloth:
        """Sets the fabric of all panels without one of their own: a Fabric, or the name of a preset."""
        return self._change("set_fabric", fabric=as_fabric(fabric))

    def set_panel_fabric(self, panel: str, fabric: FabricLike) -> Cloth:
        """Sets the fabric of one panel.  The name of a missing panel raises InputError when a simulation is made."""
        return self._change("set_panel_fabric", panel=panel, fabric=as_fabric(fabric))

    def set_panel_rest_stretch(self, panel: str, *, u: float = 1, v: float = 1) -> Cloth:
        """Factors on a panel's rest length along warp and weft: below 1 it is elastic."""
        return self._change("set_panel_rest_stretch", panel=panel, u=u, v=v)

    def set_panel_pressure(self, panel: str, Pa: float) -> Cloth:
        """Sets a pressure towards a panel's right side, outwards where the cloth is worn or closed: balloons, cushions.

        It acts once all garments are on; after a sewing it is ramped up with gravity, in half a second.
        """
        return self._change("set_panel_pressure", panel=panel, Pa=Pa)

    def place(self, translation_m: ArrayLike = (0, 0, 0), *, rotation_deg: ArrayLike = (0, 0, 0)) -> Cloth:
        """x -> R x + t with R = Rz Ry Rx, about the origin."""
        return self._change(
            "place",
            translation_m=_arrays.point(translation_m, "translation_m"),
            rotation_deg=_arrays.point(rotation_deg, "rotation_deg"),
        )

    def __repr__(self) -> str:
        how, arguments = self._calls[0]
        where = arguments.get("path") or ", ".join(f"{k}={v}" for k, v in arguments.items() if isinstance(v, (int, float)))
        return f"<Cloth {how} {where}>"


def as_cloths(given: Any) -> list[Cloth]:
    cloths = [given] if isinstance(given, Cloth) else list(given)
    for cloth in cloths:
        if not isinstance(cloth, Cloth):
            raise TypeError(f"cloth: expected a toile.Cloth or a list of them, got {type(cloth).__name__}")
    return cloths

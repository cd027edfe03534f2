"""OBJ: meshes for Toile, and those that Toile writes."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .errors import ToileError


def decimal(value: float) -> str:
    """As many digits as tell any two float32 apart."""
    return f"{float(value):.9g}"


def write(path: Path, name: str, positions_m: np.ndarray, triangles: np.ndarray, uv_m: np.ndarray | None = None) -> None:
    """`uv_m` (triangles, 3, 2): the drawing, per corner.  The file appears when it is complete."""
    lines = [f"o {name}"]
    lines += [f"v {decimal(x)} {decimal(y)} {decimal(z)}" for x, y, z in np.asarray(positions_m, dtype=np.float32)]
    corners = np.asarray(triangles) + 1
    if uv_m is None:
        lines += [f"f {a} {b} {c}" for a, b, c in corners]
    else:
        lines += [f"vt {u:.9g} {v:.9g}" for u, v in np.asarray(uv_m).reshape(-1, 2)]
        lines += [f"f {a}/{k} {b}/{k + 1} {c}/{k + 2}" for k, (a, b, c) in zip(range(1, 3 * len(corners) + 1, 3), corners)]
    partial = path.with_name(path.name + ".partial")
    partial.write_text("\n".join(lines) + "\n")
    os.replace(partial, path)


@dataclass
class Mesh:
    """What Toile writes: triangles; the drawing and the panel of each, where there are any."""

    positions: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (t, 3)
    uv: np.ndarray | None = None  # (t, 3, 2)
    panel: np.ndarray | None = None  # (t,), into panel_names
    panel_names: list[str] = field(default_factory=list)


def read(path: Path) -> Mesh:
    """An OBJ that Toile wrote.  Others are for Blender's own importer."""
    positions: list[list[float]] = []
    drawn: list[list[float]] = []
    corners: list[list[int]] = []
    corner_uv: list[list[int]] = []
    panels: dict[str, int] = {}
    panel_of: list[int] = []
    panel = garment = ""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        kind, _, rest = line.partition(" ")
        try:
            if kind == "v":
                positions.append([float(word) for word in rest.split()[:3]])
            elif kind == "vt":
                drawn.append([float(word) for word in rest.split()[:2]])
            elif kind == "o":
                garment = rest.strip()
            elif kind == "g":
                panel = rest.strip()
            elif kind == "f":
                words = [word.split("/") for word in rest.split()]
                if len(words) != 3:
                    raise ValueError(f"{len(words)} corners")
                corners.append([int(word[0]) - 1 for word in words])
                if all(len(word) > 1 and word[1] for word in words):
                    corner_uv.append([int(word[1]) - 1 for word in words])
                panel_of.append(panels.setdefault(panel or garment, len(panels)))
        except ValueError as error:
            raise ToileError(f"{path}:{number}: expected numbers and triangles as Toile writes them, got {line!r} ({error})") from None
    mesh = Mesh(np.array(positions, dtype=np.float64).reshape(-1, 3), np.array(corners, dtype=np.int64).reshape(-1, 3))
    if mesh.triangles.size and not (0 <= mesh.triangles.min() and mesh.triangles.max() < len(positions)):
        raise ToileError(f"{path}: expected corners from 1 to {len(positions)}, got {mesh.triangles.min() + 1} to {mesh.triangles.max() + 1}")
    if corner_uv and len(corner_uv) == len(corners):
        mesh.uv = np.array(drawn)[np.array(corner_uv)]
    mesh.panel, mesh.panel_names = np.array(panel_of, dtype=np.int64), list(panels)
    return mesh

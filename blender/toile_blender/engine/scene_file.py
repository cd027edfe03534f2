"""Scenes for `toile run`: from words of the add-on to the JSON of docs/scenes.md."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .obj_file import decimal

_DRAPE_S = 20.0  # the longest drape, as `toile dress` has it


@dataclass
class Pin:
    """One particle that is held where it is (fixed), led through `path_m` (rows [t_s, x, y, z]), or carried by the body."""

    near_m: np.ndarray
    hold: str = "fixed"
    path_m: np.ndarray | None = None

    def as_json(self) -> dict[str, Any]:
        pin: dict[str, Any] = {"near_m": _numbers(self.near_m), "hold": self.hold}
        if self.hold == "path":
            assert self.path_m is not None
            pin["path_m"] = [[float(row[0]), *_numbers(row[1:])] for row in self.path_m]
        return pin


@dataclass
class Garment:
    name: str
    pattern: str = ""  # its path, or
    mesh: str = ""  # that of a mesh beside the scene, with a drawing in metres
    fabric: str = "cotton"
    own_numbers: dict[str, float] = field(default_factory=dict)  # of the fabric: keys of docs/scenes.md#fabric-keys
    pins: list[Pin] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        cloth: dict[str, Any] = {"name": self.name}
        if self.pattern:
            cloth["pattern"] = self.pattern
        else:
            cloth.update(mesh=self.mesh, rest_shape="drawing")
        cloth["fabric"] = {"base": self.fabric, **self.own_numbers} if self.own_numbers else self.fabric
        if self.pins:
            cloth["pins"] = [pin.as_json() for pin in self.pins]
        return cloth


@dataclass
class World:
    gravity_m_per_s2: np.ndarray
    wind_m_per_s: np.ndarray

    def as_json(self) -> dict[str, Any]:
        return {"gravity_m_per_s2": _as_typed(self.gravity_m_per_s2), "wind_m_per_s": _as_typed(self.wind_m_per_s)}


@dataclass
class Body:
    """What is dressed, or another solid."""

    mesh: str
    friction: float | None = None  # None: the fabric's
    motion: str = ""  # a point cache beside the scene

    def as_json(self, fps: float) -> dict[str, Any]:
        body: dict[str, Any] = {"mesh": self.mesh, "unit": "m", "up": "y"}  # turned by engine/axes.py, and by nobody else
        if self.friction is not None:
            body["friction"] = self.friction
        if self.motion:
            body["motion"] = {"file": self.motion, "fps": fps, "lead_in_s": 0}
        return body


@dataclass
class Around:
    """Everything but the cloth."""

    body: Body | None
    solids: list[Body]
    world: World
    fps: float


def dress_scene(garment: Garment, around: Around, longest_s: float = _DRAPE_S) -> dict[str, Any]:
    """The cloth comes to rest, on a body that stands or held by pins."""
    scene = _scene(garment, around)
    scene["time"].update(seconds=longest_s, until_still=True)
    return scene


def motion_scene(garment: Garment, around: Around, frames: int, start: str = "") -> dict[str, Any]:
    """`frames` samples, sample 0 included.  `start`: the folder of the run that dressed a pattern."""
    scene = _scene(garment, around)
    if start:
        scene["start"] = start
    if any(solid.motion for solid in (around.body, *around.solids) if solid is not None):
        scene["time"]["drape_seconds"] = 0  # and a motion from a file ends by itself
    else:
        scene["time"].update(seconds=frames / around.fps, until_still=False)
    return scene


def _scene(garment: Garment, around: Around) -> dict[str, Any]:
    scene: dict[str, Any] = {"name": garment.name, "cloth": [garment.as_json()], "world": around.world.as_json(), "time": {"fps": around.fps}}
    if around.body is not None:
        scene["body"] = around.body.as_json(around.fps)
    if around.solids:
        scene["solids"] = [solid.as_json(around.fps) for solid in around.solids]
    return scene


def _numbers(values: np.ndarray) -> list[float]:
    """The decimals that an OBJ of the same float32 has, so that a pin finds its vertex."""
    return [float(decimal(np.float32(value))) for value in values]


def _as_typed(values: np.ndarray) -> list[float]:
    """Blender keeps seven digits: what the user typed is 9.81, not 9.81000042."""
    return [float(f"{value:.7g}") + 0.0 for value in values]


def write(path: Path, scene: dict[str, Any]) -> None:
    partial = path.with_name(path.name + ".partial")
    partial.write_text(json.dumps(scene, indent=1, allow_nan=False) + "\n")
    os.replace(partial, path)

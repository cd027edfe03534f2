"""A mesh object as cloth: its particles, how it rests, where it starts, what holds it."""

from __future__ import annotations

import bpy
import numpy as np

from .engine import garment_mesh
from .engine.errors import ToileError
from .engine.scene_file import Pin
from .evaluate import check_order, drawing, evaluated, only_deforming, triangles, undeformed

# A UV map in metres has the area of the surface, but for ease and gathers; docs/scenes.md#meshes.
_METRIC_RATIO = 1.5


class ClothObject:
    """`particles` of each vertex (-1: in no face); arrays per particle have the order in which Toile keeps them."""

    def __init__(self, obj: bpy.types.Object) -> None:
        check_order(obj)
        matrix = np.array(obj.matrix_world)
        corners = triangles(obj.data, matrix)
        if len(corners) == 0:
            raise ToileError(f"'{obj.name}' has no faces: there is nothing to be cloth")
        self.name = obj.name
        self.particles, self.count = garment_mesh.particles_of(undeformed(obj), corners)
        used = np.flatnonzero(self.particles >= 0)
        self._vertex = used[np.unique(self.particles[used], return_index=True)[1]]  # the first of each particle
        self._corners = corners
        self.triangles = self.particles[corners]
        self._rest = undeformed(obj).astype(np.float64)
        self._uv = drawing(obj.data, matrix)

    def now(self, obj: bpy.types.Object) -> np.ndarray:
        """(particles, 3), float32 metres: deformed as at the frame that is shown."""
        with only_deforming(obj):
            points, _ = evaluated(obj)
        if len(points) != len(self.particles):
            raise ToileError(f"the modifiers of '{self.name}' make {len(points)} vertices of {len(self.particles)}: apply them")
        return points[self._vertex]

    def rest(self, kind: str, start: np.ndarray) -> np.ndarray:
        """(triangles, 3, 2): the drawing in metres."""
        if kind == "AUTOMATIC":
            ratio = garment_mesh.area_ratio(self._rest, self._corners, self._uv) if self._uv is not None else 0.0
            kind = "DRAWING" if 1 / _METRIC_RATIO < ratio < _METRIC_RATIO else "MODELLED"
        if kind == "DRAWING":
            if self._uv is None:
                raise ToileError(f"'{self.name}' has no UV map to be its drawing")
            return self._uv
        if kind == "MODELLED":
            return garment_mesh.rest_drawing(self._rest, self._corners, self._uv)
        return garment_mesh.rest_drawing(start.astype(np.float64), self.triangles, self._uv)


class Held:
    """Which particles the vertex groups hold, and how; where they are led is added frame by frame."""

    def __init__(self, obj: bpy.types.Object, particles: np.ndarray, pins: list[tuple[str, str]], least_weight: float) -> None:
        self._hold: dict[int, str] = {}
        self._paths: list[np.ndarray] = []  # [frame] of the particles that are led
        for name, hold in pins:
            group = obj.vertex_groups.get(name)
            if group is None:
                raise ToileError(f"'{obj.name}' has no vertex group '{name}'" if name else "a pin has no vertex group: choose one, or remove the pin")
            vertices = [v.index for v in obj.data.vertices if any(g.group == group.index and g.weight >= least_weight for g in v.groups)]
            held = {int(particles[v]) for v in vertices if particles[v] >= 0}
            if not held:
                raise ToileError(f"no vertex of the group '{name}' of '{obj.name}' has a weight of {least_weight:g} or more")
            for particle in sorted(held):
                self._hold.setdefault(particle, hold)  # the upper group of the list wins
        self._origin = np.zeros((0, 3))
        self._led = np.array([p for p in sorted(self._hold) if self._hold[p] == "path"], dtype=np.int64)

    @property
    def leads(self) -> bool:
        return len(self._led) > 0

    def begin(self, points: np.ndarray) -> None:
        """Where the object has its particles while the garment is dressed: it is led by what they move from there."""
        self._origin = points[self._led].astype(np.float64)

    def lead(self, points: np.ndarray) -> None:
        """Where the object has its particles at the next frame."""
        self._paths.append(points[self._led] - self._origin)

    def pins(self, start: np.ndarray, fps: float, pose_blend: np.ndarray | None = None) -> list[Pin]:
        """At `start`; with paths where frames were added, before them `pose_blend` (shares of the way from `start` to the first of them)."""
        _, first, counts = np.unique(start, axis=0, return_inverse=True, return_counts=True)
        for particle in sorted(self._hold):
            if counts[np.ravel(first)[particle]] > 1:
                raise ToileError(f"a pinned vertex near {start[particle].tolist()} (metres, y up) lies exactly on another one: Mesh > Merge > By Distance")
        times, paths = None, None
        if self._paths:
            lead_in = [share * self._paths[0] for share in (pose_blend if pose_blend is not None else [])]
            paths = start[self._led].astype(np.float64) + np.stack([*lead_in, *self._paths])
            times = np.arange(len(paths)) / fps
        pins = []
        for particle in sorted(self._hold):
            hold, path = self._hold[particle], None
            if hold == "path":
                if times is None or paths is None:
                    hold = "fixed"  # while it drapes nothing moves
                else:
                    path = np.column_stack([times, paths[:, int(np.searchsorted(self._led, particle))]])
            pins.append(Pin(start[particle], hold, path))
        return pins

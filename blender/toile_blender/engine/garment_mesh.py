"""A garment that is modelled already: which vertices are one particle, and the drawing that says how it rests.

Toile joins vertices that a file had to split along seams (docs/scenes.md#split-vertices).  Here the same is done first, so that it is known which
particle moves which vertex.
"""

from __future__ import annotations

import numpy as np

from .errors import ToileError

_LEVEL = 1e-3  # sine of the slope below which a face counts as level


def particles_of(positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, int]:
    """(particle of each vertex, -1 for those in no face; count).  Two open edges that lie exactly on each other, run in opposite directions and have no
    third one there are one edge: what importers split.  The others keep their order."""
    joined = np.arange(len(positions))

    def root(i: int) -> int:
        while joined[i] != i:
            joined[i] = joined[joined[i]]
            i = joined[i]
        return int(i)

    sides = {}  # (from, to) by vertex
    for triangle in triangles.tolist():
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            sides[a, b] = sides.get((a, b), 0) + 1
    by_place: dict[tuple, list[tuple[int, int]]] = {}
    place = [tuple(p) for p in np.asarray(positions).tolist()]
    for a, b in sides:
        if (b, a) not in sides:
            by_place.setdefault((min(place[a], place[b]), max(place[a], place[b])), []).append((a, b))
    for here in by_place.values():
        if len(here) == 2 and place[here[0][0]] == place[here[1][1]] and place[here[0][0]] != place[here[0][1]]:
            (a, b), (c, d) = here
            for i, j in ((a, d), (b, c)):
                low, high = sorted((root(i), root(j)))
                joined[high] = low
    particle = np.full(len(positions), -1)
    count = 0
    for i in sorted(set(triangles.ravel().tolist())):
        first = root(i)
        if first == i:
            particle[i], count = count, count + 1
        else:
            particle[i] = particle[first]
    return particle, count


def _laid_flat(triangles_m: np.ndarray, warp: np.ndarray) -> np.ndarray:
    """(t, 3, 2): each triangle in the plane, in metres, `warp` (t, 3) along the second axis."""
    ab, ac = triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0]
    normal = np.cross(ab, ac)
    area = np.linalg.norm(normal, axis=1)
    if np.any(area == 0):
        raise ToileError(f"the garment has a face without area, triangle {int(np.argmin(area))}: Mesh > Clean Up > Degenerate Dissolve")
    normal /= area[:, None]
    along = warp - np.sum(warp * normal, axis=1)[:, None] * normal
    length = np.linalg.norm(along, axis=1)
    # A level face has no warp upwards: there it runs away from the front, alike in all of a sheet that lies.
    level = length < _LEVEL * np.maximum(np.linalg.norm(warp, axis=1), 1e-30)
    away = np.array([0.0, 0.0, -1.0])
    along[level] = away - (normal[level] @ away)[:, None] * normal[level]
    length[level] = np.linalg.norm(along[level], axis=1)
    along /= length[:, None]
    across = np.cross(along, normal)
    flat = np.zeros((len(triangles_m), 3, 2))
    for corner, side in ((1, ab), (2, ac)):
        flat[:, corner, 0] = np.sum(side * across, axis=1)
        flat[:, corner, 1] = np.sum(side * along, axis=1)
    return flat


def rest_drawing(rest_m: np.ndarray, triangles: np.ndarray, uv: np.ndarray | None = None) -> np.ndarray:
    """(t, 3, 2), metres: every triangle as it is in `rest_m` (vertices of the undeformed mesh).  The warp runs as the second axis of `uv` (t, 3, 2) does;
    without a UV map, or where it has no area, upwards."""
    corners = rest_m[triangles]
    warp = np.broadcast_to(np.array([0.0, 1.0, 0.0]), (len(triangles), 3)).copy()
    if uv is not None:
        p, q = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
        area = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
        drawn = np.abs(area) > 1e-9 * np.maximum(np.sum(p * p, axis=1), np.sum(q * q, axis=1))
        # dx/dv of the map from the UV map to the surface; mirrored islands keep their direction.
        ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        up = (p[:, :1] * ac - q[:, :1] * ab) * np.sign(area)[:, None]
        warp[drawn] = up[drawn]
    return _laid_flat(corners, warp)


def area_ratio(rest_m: np.ndarray, triangles: np.ndarray, uv: np.ndarray) -> float:
    """Area of the UV map over that of the surface: near 1 where the map is in metres."""
    p, q = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    corners = rest_m[triangles]
    surface = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    return float(np.abs(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() / surface)

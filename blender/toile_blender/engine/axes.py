"""Blender's world (z up, lengths in its units) and Toile's (y up, metres): coordinates change places and signs, so nothing is rounded but by the unit."""

from __future__ import annotations

import numpy as np


def to_toile(points: np.ndarray, metres_per_unit: float = 1.0) -> np.ndarray:
    """(..., 3) of the world of Blender, as float64 metres of Toile: (x, z, -y)."""
    x, y, z = np.moveaxis(np.asarray(points, dtype=np.float64), -1, 0)
    return np.stack([x, z, -y], axis=-1) * metres_per_unit


def to_blender(points_m: np.ndarray, metres_per_unit: float = 1.0) -> np.ndarray:
    """The way back: (x, -z, y)."""
    x, y, z = np.moveaxis(np.asarray(points_m, dtype=np.float64), -1, 0)
    return np.stack([x, -z, y], axis=-1) / metres_per_unit


def moved(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(n, 3) through a 4 x 4 matrix, in float64."""
    matrix = np.asarray(matrix, dtype=np.float64)
    return np.asarray(points, dtype=np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def turns_inside_out(matrix: np.ndarray) -> bool:
    """A mirrored object: its faces run clockwise in the world."""
    return float(np.linalg.det(np.asarray(matrix, dtype=np.float64)[:3, :3])) < 0

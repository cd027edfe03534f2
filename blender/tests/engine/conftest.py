"""The program, and small shapes that the tests share.  TOILE_PROGRAM names the program of the build; without it tests that run it are skipped."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest


@pytest.fixture
def program() -> Path:
    path = os.environ.get("TOILE_PROGRAM", "")
    if not path or not Path(path).is_file():
        pytest.skip("there is no program `toile` (TOILE_PROGRAM)")
    return Path(path)


def sheet(cells: int = 4, edge_m: float = 0.05, height_m: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """A level square around the y axis."""
    line = (np.arange(cells + 1) - cells / 2) * edge_m
    x, z = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
    n = cells + 1
    a = np.array([n * i + j for i in range(cells) for j in range(cells)])
    triangles = np.concatenate([np.stack([a, a + 1, a + n], axis=-1), np.stack([a + 1, a + n + 1, a + n], axis=-1)])
    return np.stack([x, np.full_like(x, height_m), z], axis=-1), triangles

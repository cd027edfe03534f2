"""Small scenes that the tests share.  What they need from the build comes in the environment (tests.cmake)."""

from __future__ import annotations

import os
import pathlib

import numpy as np
import pytest

import toile

root = pathlib.Path(os.environ.get("TOILE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))


def one_core() -> None:
    """For what is started from here.  Threads that wait for each other many times in a step are slow beside a busy build: 138 s for 4 s of work were seen."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def has_pictures() -> bool:
    """Whether this build draws."""
    try:
        return bool(level_sheet().picture(width=8, height=8, samples=1))
    except toile.Error:
        return False


def sheet_arrays(cells: int = 8, edge_m: float = 0.04):
    """A level square of cloth, its middle at the origin."""
    line = (np.arange(cells + 1) - cells / 2) * edge_m
    x, z = np.meshgrid(line, line, indexing="ij")
    vertices = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij")
    a = (i * (cells + 1) + j).ravel()
    b, c, d = a + cells + 1, a + cells + 2, a + 1
    faces = np.concatenate([np.stack([a, c, b], axis=-1), np.stack([a, d, c], axis=-1)]).astype(np.int32)
    return vertices, faces


def box_arrays(low=(-0.1, -0.3, -0.1), high=(0.1, -0.1, 0.1)):
    """A closed box, its faces counter-clockwise from outside."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    return low + corners * (high - low), np.array(faces, dtype=np.int32)


def level_sheet(**options) -> toile.Simulation:
    return toile.Simulation(toile.Cloth(*sheet_arrays()), **options)


@pytest.fixture
def sheet():
    return level_sheet(fabric="cotton")


@pytest.fixture
def draped():
    """Cloth that falls on a cylinder, just above it."""
    cloth = toile.Cloth(*sheet_arrays()).place((0, 0.01, 0))
    return toile.Simulation(cloth, "silk", toile.Body.cylinder(radius_m=0.08, height_m=0.2), threads=1)

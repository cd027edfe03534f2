"""Bodies that a skeleton moves."""

import pathlib

import numpy as np
import pytest
from conftest import sheet_arrays

import toile

DATA = pathlib.Path(__file__).resolve().parents[2] / ".." / "shared" / "data"
FOX = DATA / "gltf" / "Fox.glb"


def moved(body):
    """How far the farthest vertex of the body goes in 0.3 s, m."""
    vertices, faces = sheet_arrays(cells=2)
    sim = toile.Simulation(toile.Cloth(vertices + [0, 5, 0], faces), "silk", body)
    start = sim.body_positions_m.copy()
    for _ in range(9):
        sim.advance(1 / 30)
    return np.linalg.norm(sim.body_positions_m - start, axis=1).max()


@pytest.mark.skipif(not FOX.exists(), reason=f"needs {FOX}")
def test_a_clip_of_a_gltf_file_moves_its_body():
    still = toile.Body.from_file(FOX, unit="cm")
    assert moved(still) == 0
    walk, run = (moved(toile.Body.from_file(FOX, unit="cm", motion=FOX, clip=clip)) for clip in ("Walk", 2))
    assert 0.01 < walk and 0.01 < run and walk != run
    with pytest.raises(toile.InputError, match="Survey, 1 Walk, 2 Run"):
        moved(toile.Body.from_file(FOX, unit="cm", motion=FOX))
    with pytest.raises(toile.InputError, match="Gallop"):
        moved(toile.Body.from_file(FOX, unit="cm", motion=FOX, clip="Gallop"))


MAKEHUMAN, WALK = DATA / "bodies" / "makehuman", DATA / "mocap" / "cmu_02_01_walk.bvh"


@pytest.mark.skipif(not (MAKEHUMAN.exists() and WALK.exists()), reason=f"needs {MAKEHUMAN} and {WALK}")
def test_a_recording_moves_makehumans_body():
    made = {"unit": "dm", "rig": MAKEHUMAN / "rig.cmu_mb.json", "motion": WALK}
    assert 0.01 < moved(toile.Body.from_file(MAKEHUMAN / "base.obj", **made)) < 5
    target = MAKEHUMAN / "caucasian-female-young.target"
    shaped, none = (toile.Body.from_file(MAKEHUMAN / "base.obj", **made, targets={target: share}) for share in (1, 0))
    assert moved(shaped) != moved(none)
    with pytest.raises(toile.InputError, match="HIERARCHY"):
        moved(toile.Body.from_file(MAKEHUMAN / "base.obj", **made, targets={WALK: 1}))

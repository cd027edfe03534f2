"""One scene, by Python, by the C++ library and by the program: the same hash."""

import json
import os
import subprocess

import pytest
from conftest import sheet_arrays

import toile

twin = os.environ.get("TOILE_TWIN", "")
program = os.environ.get("TOILE_PROGRAM", "")


def made():
    cloth = toile.Cloth.grid(width_m=0.32, height_m=0.32, edge_m=0.04).set_fabric("wool")
    cloth.place((0.01, 0.02, 0), rotation_deg=(-90, 0, 0))
    return toile.Simulation(cloth, body=toile.Body.cylinder(radius_m=0.08, height_m=0.2).set_friction(0.2), threads=2)


def pull(sim, hand, first, end):
    for k in range(first, end):
        sim.drag(hand, (0.1, 0.05 + 0.01 * k, 0.1))
        assert sim.advance(1 / 30).ok


@pytest.mark.skipif(not twin, reason="TOILE_TWIN does not name the C++ program that does the same")
def test_python_and_cpp_have_the_same_bits_and_take_each_others_states(tmp_path):
    def by_cpp(*words):
        return subprocess.run([twin, *words], check=True, capture_output=True, text=True, cwd=tmp_path).stdout.strip()

    sim = made()
    sim.pin([0])
    hand = sim.grab(7, (0.25, 0.25, 0.5))
    pull(sim, hand, 0, 3)
    sim.state().save(tmp_path / "python.state")
    pull(sim, hand, 3, 6)
    assert sim.state_hash == by_cpp()
    assert sim.state_hash == by_cpp("python.state")
    other = made()
    other.set_state(toile.State.load(tmp_path / "twin.state"))
    pull(other, hand, 3, 6)
    assert other.state_hash == sim.state_hash


@pytest.mark.skipif(not program, reason="TOILE_PROGRAM does not name the program `toile`")
def test_a_scene_file_has_the_bits_of_the_program(tmp_path):
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps({
        "cloth": [{"grid": {"width_m": 0.32, "height_m": 0.32, "edge_m": 0.04}, "fabric": "silk",
                   "placement": {"translation_m": [0, 0.02, 0], "rotation_deg": [-90, 0, 0]}}],
        "body": {"cylinder": {"radius_m": 0.08, "height_m": 0.2}},
        "time": {"fps": 30, "seconds": 0.4},
    }))
    done = subprocess.run([program, "run", scene, "--out", tmp_path / "out", "--no-preview", "--quiet"], cwd=tmp_path)
    assert done.returncode in (0, 5)  # 5: it does not rest yet
    report = json.loads((tmp_path / "out/report.json").read_text())
    sim = toile.Simulation.from_scene(scene)
    sim.run()
    assert sim.state_hash == report["state_hash"]


def test_arrays_give_the_same_bits_twice():
    hashes = set()
    for _ in range(2):
        sim = toile.Simulation(toile.Cloth(*sheet_arrays()), "silk")
        sim.advance(0.1)
        hashes.add(sim.state_hash)
    assert len(hashes) == 1

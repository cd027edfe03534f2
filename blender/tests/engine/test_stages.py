"""Scenes, runs and jobs against the program itself."""

from __future__ import annotations

import json
import os
import subprocess
import time

import numpy as np
import pytest
from conftest import sheet

from toile_blender.engine import fabrics, garment_mesh, obj_file, point_cache, pose_blend, run_files, scene_file
from toile_blender.engine.errors import ToileError
from toile_blender.engine.job import Job, Waiting
from toile_blender.engine.run_files import Progress
from toile_blender.engine.scene_file import Pin
from toile_blender.engine.stage import Stage

FPS = 24.0
WORLD = scene_file.World(np.array([0, -9.81, 0]), np.zeros(3))


def is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def write_inputs(stage: Stage, pins=(), seconds=0.5, options=("--quality", "draft"), fabric="silk", numbers=None) -> None:
    """A sheet that hangs by its pins, or falls."""
    folder = stage.begin_inputs()
    positions, triangles = sheet()
    obj_file.write(folder / "cloth.obj", "cloth", positions, triangles, garment_mesh.rest_drawing(positions, triangles))
    garment = scene_file.Garment("sheet", mesh="cloth.obj", fabric=fabric, own_numbers=numbers or {}, pins=list(pins))
    scene = scene_file.motion_scene(garment, scene_file.Around(None, [], WORLD, FPS), round(seconds * FPS))
    stage.end_inputs(scene, list(options), "toile", [])


def steps_of(stage: Stage, program, seconds=0.5):
    def steps(job):
        yield Progress("writing")
        arguments = stage.command(["--quality", "draft"], 1)
        if arguments:
            yield from job.run(program, arguments, stage.folder, stage.output, lambda: run_files.progress(stage.run, round(seconds * FPS)))

    return steps


def hash_of(folder, program, **garment) -> str:
    stage = Stage(folder)
    write_inputs(stage, corner_pins(), **garment)
    job = Job(steps_of(stage, program))
    job.finish()
    assert job.error == ""
    return json.loads((stage.run / "report.json").read_text())["input_hash"]


def check(folder, program, numbers) -> None:
    stage = Stage(folder)
    write_inputs(stage, numbers=numbers)
    done = subprocess.run([program, "check", stage.inputs / "scene.json"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def corner_pins(hold="fixed", path=None):
    positions, _ = sheet()
    return [Pin(positions[k], hold, None if path is None else path(positions[k])) for k in (0, 4)]


def test_a_scene_runs_and_its_verdict_is_read(tmp_path, program):
    stage = Stage(tmp_path / "a")
    write_inputs(stage, corner_pins())
    job = Job(steps_of(stage, program))
    job.finish()
    assert job.error == ""
    reader = point_cache.Reader(stage.run / "cloth.pc2")
    positions, triangles = sheet()
    assert (reader.points, reader.samples) == (25, 12)
    assert np.array_equal(reader.sample(0), positions.astype(np.float32))
    assert np.array_equal(obj_file.read(stage.run / "cloth.obj").triangles, triangles)
    assert np.array_equal(reader.sample(11)[[0, 4]], positions[[0, 4]].astype(np.float32))  # pinned
    assert reader.sample(11)[:, 1].min() < 0.97
    verdict = run_files.verdict(stage.run)
    assert verdict.line.startswith("pass") and verdict.reached_its_end and verdict.crossings == 0
    assert run_files.rate(stage.run) == FPS
    progress = run_files.progress(stage.run, 12)
    assert (progress.words, progress.share) == ("frame 12 of 12", 1.0)


def test_pins_are_led_through_their_paths(tmp_path, program):
    stage = Stage(tmp_path / "a")
    rise = lambda p: np.array([[k / FPS, p[0], p[1] + 0.01 * k, p[2]] for k in range(12)])  # noqa: E731
    write_inputs(stage, corner_pins("path", rise))
    Job(steps_of(stage, program)).finish()
    reader = point_cache.Reader(stage.run / "cloth.pc2")
    for k in range(12):
        assert reader.sample(k)[0, 1] == pytest.approx(1 + 0.01 * k, abs=1e-6)


def test_what_is_finished_is_not_run_again(tmp_path, program):
    stage = Stage(tmp_path / "a")
    write_inputs(stage)
    Job(steps_of(stage, program)).finish()
    (stage.folder / "particles.npy").write_bytes(b"")
    write_inputs(stage)
    assert stage.command([], 1) == [] and stage.particles.exists()
    write_inputs(stage, fabric="denim")
    assert stage.command([], 1)[0] == "run" and not stage.particles.exists()
    Job(steps_of(stage, program)).finish()
    write_inputs(stage, fabric="denim", options=("--quality", "final"))
    assert stage.command([], 1)[0] == "run"
    assert not stage.new_inputs.exists()


def test_stop_leaves_nothing_running_and_it_goes_on_from_there(tmp_path, program):
    stage = Stage(tmp_path / "a")
    write_inputs(stage, corner_pins(), seconds=3000)
    job = Job(steps_of(stage, program, 3000))
    while job.tick() and point_cache.samples_so_far(stage.run / "cloth.pc2") < 60:
        time.sleep(0.02)
    pid = job.pid
    assert is_alive(pid) and isinstance(job.progress, Waiting) and 0 < job.progress.share < 0.1
    job.stop()
    job.finish()
    assert job.stopped and job.error == "" and not is_alive(pid)
    assert point_cache.Reader(stage.run / "cloth.pc2").samples >= 60
    write_inputs(stage, corner_pins(), seconds=3000)
    assert stage.command([], 1)[:2] == ["resume", str(stage.run)]
    again = Job(steps_of(stage, program, 3000))
    before = point_cache.samples_so_far(stage.run / "cloth.pc2")
    while again.tick() and point_cache.samples_so_far(stage.run / "cloth.pc2") < before + 20:
        time.sleep(0.02)
    pid = again.pid
    again.abandon()
    assert again.done and not is_alive(pid)


def test_a_process_that_does_not_listen_is_killed(tmp_path):
    deaf = tmp_path / "deaf"
    deaf.write_text("#!/bin/sh\ntrap '' INT TERM\nwhile :; do sleep 0.1; done\n")
    deaf.chmod(0o755)

    def steps(job):
        yield from job.run(deaf, [], tmp_path, tmp_path / "out.txt", lambda: Progress("at work"))

    job = Job(steps)
    job.tick()
    pid = job.pid
    job.stop()
    job.finish()
    assert not is_alive(pid)


def test_errors_of_the_program_are_the_users_text(tmp_path, program):
    stage = Stage(tmp_path / "a")
    write_inputs(stage, [Pin(sheet()[0][0]), Pin(sheet()[0][0])])
    job = Job(steps_of(stage, program))
    job.finish()
    assert "pins that hold different particles" in job.error and not job.error.startswith("toile:")
    job = Job(lambda job: job.run(tmp_path / "nowhere", [], tmp_path, tmp_path / "out.txt", lambda: Progress("")))
    job.finish()
    assert "does not run" in job.error


def test_fabrics_and_their_numbers_are_those_of_the_program(tmp_path, program):
    """Cotton with every number of cotton is the same input; the least and the most are taken."""
    plain = hash_of(tmp_path / "plain", program, fabric="cotton")
    assert len({plain, *(hash_of(tmp_path / name, program, fabric=name) for name in fabrics.NAMES)}) == len(fabrics.NAMES)
    assert hash_of(tmp_path / "numbers", program, fabric="cotton", numbers={n.key: n.cotton for n in fabrics.NUMBERS}) == plain
    for limit in ("least", "most"):
        check(tmp_path / limit, program, {n.key: getattr(n, limit) for n in fabrics.NUMBERS})


def test_crossings_are_vertices_of_the_cloth(tmp_path):
    audit = tmp_path / "audit.json"
    crossing = {"edge": [3, 1], "edge_of": "cloth", "triangle": 0, "triangle_of": "body", "position_m": [0, 0, 0]}
    through_cloth = {"edge": [7, 8], "edge_of": "body", "triangle": 1, "triangle_of": "cloth", "position_m": [0, 0, 0]}
    audit.write_text(json.dumps({"worst_frame": 4, "worst_frame_crossings": [crossing, through_cloth]}))
    found = run_files.crossings(audit, [(0, 1, 2), (4, 5, 6)])
    assert (found.frame, found.vertices) == (4, [1, 3, 4, 5, 6])
    audit.write_text(json.dumps({"worst_frame": None, "worst_frame_crossings": []}))
    assert run_files.crossings(audit, []).frame == -1


def test_a_verdict_says_reasons_and_warnings(tmp_path):
    report = {"verdict": "fail", "reasons": ["stretch"], "reason_details": {"stretch": "too narrow by 2 cm"}, "warnings": ["w"], "ended": "still"}
    report["penetrations"] = {"cloth_body_edges": {"max": 2}, "cloth_body_edges_outside_pinches": {"max": 2}, "cloth_cloth_edges": {"max": 1}}
    (tmp_path / "report.json").write_text(json.dumps(report))
    verdict = run_files.verdict(tmp_path)
    assert (verdict.line, verdict.passed, verdict.crossings) == ("fail: stretch", False, 3)
    assert verdict.details == ["stretch: too narrow by 2 cm", "warning: w"]
    (tmp_path / "report.json").write_text("{")
    with pytest.raises(ToileError, match="report.json"):
        run_files.verdict(tmp_path)
    with pytest.raises(ToileError, match="not finished"):
        run_files.verdict(tmp_path / "nowhere")


def test_the_drawing_survives_obj(tmp_path):
    positions, triangles = sheet()
    uv = garment_mesh.rest_drawing(positions, triangles)
    obj_file.write(tmp_path / "a.obj", "a", positions, triangles, uv)
    mesh = obj_file.read(tmp_path / "a.obj")
    assert np.array_equal(mesh.positions.astype(np.float32), positions.astype(np.float32))
    assert np.array_equal(mesh.triangles, triangles) and np.allclose(mesh.uv, uv, atol=1e-9)
    (tmp_path / "b.obj").write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(ToileError, match="corners from 1 to 1, got 1 to 3"):
        obj_file.read(tmp_path / "b.obj")
    (tmp_path / "b.obj").write_text("v 0 0 0\nf 1 1 1 1\n")
    with pytest.raises(ToileError, match="b.obj:2"):
        obj_file.read(tmp_path / "b.obj")


def test_a_pose_begins_and_ends_at_rest():
    share = pose_blend.shares(100)
    assert share[0] == 0 and np.all(np.diff(share) > 0) and share[1] < 1e-4 and 1 - 1e-4 < share[-1] < 1
    assert pose_blend.shares(0).tolist() == []

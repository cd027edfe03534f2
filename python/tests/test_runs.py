"""Runs as folders, the judge and the linter."""

import json
import threading

import pytest
from conftest import root

import toile


def test_a_run_is_written_judged_and_read_again(draped, tmp_path):
    folder = tmp_path / "run"
    with toile.RunWriter(folder, draped, fps=30) as run:
        assert run.frames == 1 and run.verdict is None
        for _ in draped.frames(0.2, fps=30):
            run.add()
    assert run.frames == 7 and run.finish() is run.verdict
    with pytest.raises(toile.Error, match="finished"):
        run.add()
    assert {"cloth.obj", "cloth.pc2", "body.obj", "body.pc2", "report.json"} <= {path.name for path in folder.iterdir()}
    assert json.loads((folder / "report.json").read_text())["state_hash"] == draped.state_hash
    read = toile.verify(folder)
    assert read.frames == run.verdict.frames == 7 and read.passed == run.verdict.passed == bool(read)
    assert read.last.cloth_body_edges == read.most.cloth_body_edges == 0 and "frames" in read.explain()
    assert [reason.code for reason in read.reasons] == [reason.code for reason in run.verdict.reasons]


def test_a_run_that_an_exception_ended_is_no_pass(draped, tmp_path):
    with pytest.raises(KeyError), toile.RunWriter(tmp_path / "run", draped) as run:
        draped.advance(1 / 30)
        run.add()
        raise KeyError
    assert run.verdict is None and not (tmp_path / "run/report.json").exists() or not toile.verify(tmp_path / "run").passed


def test_files_of_others_are_not_written_over(draped, tmp_path):
    (tmp_path / "cloth.obj").write_text("mine")
    with pytest.raises(toile.IoError, match="cloth.obj"):
        toile.RunWriter(tmp_path, draped)
    assert (tmp_path / "cloth.obj").read_text() == "mine"
    with pytest.raises(toile.IoError):
        toile.verify(tmp_path / "nowhere")


def scene(folder, seconds):
    path = folder / "scene.json"
    path.write_text(json.dumps({
        "cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.03},
                   "placement": {"translation_m": [0, 0.02, 0], "rotation_deg": [-90, 0, 0]}}],
        "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.2}}, "time": {"fps": 30, "seconds": seconds}}))
    return path


def test_a_scene_runs_into_a_folder(tmp_path):
    told = []
    verdict = toile.run_scene(scene(tmp_path, 0.3), tmp_path / "out", threads=1, progress=lambda *what: told.append(what))
    assert verdict.frames > 5 and (tmp_path / "out/cloth.pc2").is_file() and told


def test_a_progress_that_raises_ends_a_scene_and_its_exception_comes_out(tmp_path):
    def progress(*_):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        toile.run_scene(scene(tmp_path, 100), tmp_path / "out", threads=1, progress=progress)


def test_a_pattern_is_checked(tmp_path):
    good = toile.check_pattern(root / "patterns/skirt.json")
    assert good.usable and good and all(finding.severity != "error" for finding in good.findings)
    (tmp_path / "bad.json").write_text(json.dumps({"pattern": {"panels": {"front": {
        "translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": [[0, 0], [10, 0], [10, 10]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}]}}, "stitches": []}}))
    bad = toile.check_pattern(tmp_path / "bad.json")
    assert bad.findings and "front" in bad.explain() and bad.findings[0].code and "bad.json" in bad.findings[0].where
    with pytest.raises(toile.IoError):
        toile.check_pattern(tmp_path / "none.json")


def test_preview_draws_a_picture_or_says_why_not(draped, tmp_path):
    with toile.RunWriter(tmp_path / "run", draped) as run:
        draped.advance(1 / 30)
        run.add()
    worker = []

    def draw():
        try:
            toile.preview(tmp_path / "run")
            worker.append((tmp_path / "run/preview.png").is_file())
        except toile.Error as error:
            worker.append(error.code == "usage" and "pictures" in str(error))

    thread = threading.Thread(target=draw)
    thread.start()
    thread.join()
    assert worker == [True]


def test_preview_as_in_a_studio(draped, tmp_path):
    with toile.RunWriter(tmp_path / "run", draped) as run:
        draped.advance(1 / 30)
        run.add()
    try:
        toile.preview(tmp_path / "run", style="studio", close_up_m=(0, 1, 0), film=False)
    except toile.Error as error:
        assert error.code == "usage" and "pictures" in str(error)
        return
    assert (tmp_path / "run/close-up.png").stat().st_size > 1000
    assert not (tmp_path / "run/preview.mp4").exists()
    with pytest.raises(toile.InputError, match="style"):
        toile.preview(tmp_path / "run", style="oil")
    plain = (tmp_path / "run/preview.png").read_bytes()
    looks = tmp_path / "looks.json"
    looks.write_text('{"looks": [{"colour": "#c00000"}]}')
    toile.preview(tmp_path / "run", style="studio", film=False, looks=looks)
    assert (tmp_path / "run/preview.png").read_bytes() != plain
    looks.write_text('{"looks": [{"colour": "scarlet"}]}')
    with pytest.raises(toile.InputError, match="/looks/0/colour"):
        toile.preview(tmp_path / "run", film=False, looks=looks)

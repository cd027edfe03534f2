"""Batches on Dask: the same files and hashes as by the program."""

import json
import os
import pathlib
import subprocess
import sys

import pytest

import toile

program = os.environ.get("TOILE_PROGRAM", "")
needs_program = pytest.mark.skipif(not program, reason="the program is not built")
measured = {"seconds", "cpu_seconds", "memory_peak_mb", "seconds_per_frame"}
scene = {"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}}], "time": {"seconds": 0.2}}
jobs = [
    {"defaults": {"no-preview": True}},
    {"id": "one", "run": "s.json"},
    {"id": "none", "run": "nowhere.json"},
    {"id": "two", "run": "s.json", "fabric": "silk", "fps": 60},
]


def lasting(verdicts):
    return [{key: value for key, value in one.items() if key not in measured} for one in verdicts]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    pytest.importorskip("distributed", reason="Dask is not installed")
    (tmp_path / "s.json").write_text(json.dumps(scene))
    (tmp_path / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def by_the_program(folder, out="program"):
    subprocess.run([program, "batch", "jobs.jsonl", "--out", out, "--quiet"], cwd=folder, stderr=subprocess.DEVNULL)
    return [json.loads(line) for line in (folder / out / "verdicts.jsonl").read_text().splitlines()]


@needs_program
def test_a_batch_gives_the_hashes_of_the_program(folder):
    told = []
    verdicts = toile.run_batch("jobs.jsonl", "dask", program=program, processes=2, progress=lambda *what: told.append(what))
    assert [one["id"] for one in verdicts] == ["one", "none", "two"] and told[-1][:2] == ("batch", 1)
    assert [one["verdict"] for one in verdicts] == ["pass", "error", "pass"] and verdicts[1]["reasons"] == ["io"]
    assert lasting(verdicts) == lasting(by_the_program(folder))
    assert {"index.html", "verdicts.jsonl"} <= {path.name for path in pathlib.Path("dask").iterdir()}
    report = pathlib.Path("dask/runs/one/report.json").read_bytes()
    again = toile.run_batch("jobs.jsonl", "dask", program=program)
    assert lasting(again) == lasting(verdicts) and pathlib.Path("dask/runs/one/report.json").read_bytes() == report


@needs_program
def test_jobs_may_be_dicts_and_the_cluster_the_callers(folder):
    from distributed import Client

    with Client(processes=False, n_workers=1, threads_per_worker=2, dashboard_address=None) as client:
        verdicts = toile.run_batch(iter(jobs), "dask", client=client, program=program)
        assert lasting(verdicts) == lasting(by_the_program(folder))
        assert client.status == "running", "the caller's own goes on"


@needs_program
def test_what_is_no_job_is_said_with_its_line(folder):
    with pytest.raises(toile.InputError, match=r"jobs.jsonl:2:.*expected"):
        toile.run_batch([{"id": "a", "run": "s.json"}, {"id": "b", "run": "s.json", "resolutoin": 2}], "bad", program=program)
    with pytest.raises(toile.InputError, match=r"jobs\[1\]: expected a dict"):
        toile.run_batch([{"id": "a", "run": "s.json"}, 7], "bad", program=program)
    with pytest.raises(toile.InputError, match=r"jobs\[0\]"):
        toile.run_batch([{"id": "a", "run": "s.json", "fps": float("nan")}], "bad", program=program)
    with pytest.raises(toile.IoError, match="nowhere.jsonl"):
        toile.run_batch("nowhere.jsonl", "bad", program=program)
    pathlib.Path("mine").mkdir()
    pathlib.Path("mine/index.html").write_text("precious")
    with pytest.raises(toile.IoError, match="not made by an earlier batch"):
        toile.run_batch("jobs.jsonl", "mine", program=program)
    assert pathlib.Path("mine/index.html").read_text() == "precious"


@needs_program
def test_a_limit_is_a_verdict(folder):
    pathlib.Path("s.json").write_text(json.dumps({**scene, "time": {"seconds": 600}}))
    verdicts = toile.run_batch([{"id": "slow", "run": "s.json"}], "dask", program=program, limit_seconds=1)
    assert [one["reasons"] for one in verdicts] == [["limit_seconds"]]


def test_a_missing_program_is_named(folder, monkeypatch):
    monkeypatch.setenv("PATH", str(folder))
    with pytest.raises(toile.IoError, match="toile: no such program"):
        toile.run_batch("jobs.jsonl", "dask")
    with pytest.raises(toile.IoError, match="no/toile"):
        toile.run_batch("jobs.jsonl", "dask", program="no/toile")
    other = folder / "toile"
    other.write_text("#!/bin/sh\necho 0.0.7\n")
    other.chmod(0o755)
    with pytest.raises(toile.Error, match="version 0.0.7"):
        toile.run_batch("jobs.jsonl", "dask")


def test_without_dask_it_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ImportError, match=r'pip install "toile\[batch\]"'):
        toile.run_batch("jobs.jsonl", "dask")

"""A batch of jobs (docs/howto/batch.md) on Dask: each task runs some line of the job file by the program `toile`."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import threading
from pathlib import Path as FilePath
from typing import Any, Iterable, Mapping

from ._batch import _cores
from ._errors import Error, InputError, IoError
from ._progress import ProgressCall, Shown
from ._runs import Path
from ._toile import version

_errors = {2: Error, 3: InputError, 6: IoError}  # by the program's exit code; others are Error
_ran = {0, 5}  # all pass, not all pass
_interrupted = 8

_at_work: set[subprocess.Popen[str]] = set()  # in this process
_lock = threading.Lock()


def _call(words: list[str]) -> int:
    """The exit code of the program; raises what its line on stderr says where it did not do its work."""
    with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        with _lock:
            _at_work.add(process)
        try:
            said = process.communicate()[1]
        finally:
            with _lock:
                _at_work.discard(process)
    if process.returncode in _ran or process.returncode == _interrupted:
        return process.returncode
    told = said.strip().splitlines()[-1:] or [f"{words[0]} ended with {process.returncode}"]
    raise _errors.get(process.returncode, Error)(told[0].removeprefix("toile: "))


def _end_all() -> None:
    with _lock:
        for process in _at_work:
            process.terminate()


def _distributed() -> Any:
    try:
        import distributed
    except ImportError as missing:
        raise ImportError('toile.run_batch needs Dask: pip install "toile[batch]", or pip install distributed') from missing
    return distributed


def _program(program: Path | None) -> str:
    path = shutil.which(os.fspath(program or "toile"))
    if path is None:
        raise IoError(
            f"{os.fspath(program or 'toile')}: no such program, and batches need it (docs/howto/embed-in-cmake.md builds it): put it into PATH, or say program="
        )
    try:
        told = subprocess.run([path, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        raise IoError(f"{path}: cannot be asked for its version: {error}") from error
    if told != version:
        raise Error(f"{path}: version {told}, expected {version} as of this package: results could differ")
    return os.path.abspath(path)


def _job_file(jobs: Path | Iterable[Mapping[str, Any]], out: FilePath) -> tuple[FilePath, list[str]]:
    """The file, and where relative paths begin."""
    if isinstance(jobs, (str, os.PathLike)):
        return FilePath(jobs).absolute(), []
    lines = []
    for number, job in enumerate(jobs):
        if not isinstance(job, Mapping):
            raise InputError(f"jobs[{number}]: expected a dict, got {type(job).__name__}")
        try:
            lines.append(json.dumps(dict(job), allow_nan=False) + "\n")
        except (TypeError, ValueError) as error:
            raise InputError(f"jobs[{number}]: expected strings, numbers, true, false and null, got {error}") from error
    out.mkdir(parents=True, exist_ok=True)
    file = out / "jobs.jsonl"
    part = out / f"jobs.{os.getpid()}.tmp"
    part.write_text("".join(lines))
    part.replace(file)
    return file, ["--paths-from", os.getcwd()]


def _verdicts(out: FilePath) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (out / "verdicts.jsonl").read_text().splitlines()]


def _lines_left(file: FilePath, verdicts: list[dict[str, Any]]) -> list[int]:
    """Lines with a job that has no verdict.  One that ran out of time may have another time now: the program knows."""
    done = {one["line"] for one in verdicts if one["verdict"] != "error" and "time_limit" not in one["reasons"]}
    lines = file.read_text(encoding="utf-8-sig").split("\n")
    return [k for k, line in enumerate(lines, 1) if line.strip() and k not in done and "defaults" not in json.loads(line)]


def run_batch(
    jobs: Path | Iterable[Mapping[str, Any]],
    out: Path,
    *,
    client: Any = None,
    processes: int = 0,
    program: Path | None = None,
    limit_seconds: float = 0,
    limit_memory_mb: float = 0,
    progress: bool | ProgressCall | None = None,
) -> list[dict[str, Any]]:
    """Runs jobs on Dask, to the same files and hashes as the program's `toile batch`, and returns their verdicts in order.

    jobs       a job file, or its lines as dicts: {"id": "skirt-1", "dress": "skirt.json", "body": "woman"}
    out        the folder of the batch; what is done there is not done again
    client     a distributed.Client; its workers need the program and the files under the same paths.  None: a cluster on this machine
    processes  of that cluster, jobs at a time; 0: one per core
    program    the program `toile`; None: by PATH

    Raises InputError for what is no job, with its line, IoError, and ImportError where Dask is missing.  A job that goes badly is a verdict.
    """
    distributed = _distributed()
    if processes < 0:
        raise InputError(f"processes: expected 0 or more, got {processes}")
    toile = _program(program)
    folder = FilePath(out).absolute()
    file, paths_from = _job_file(jobs, folder)
    words = [toile, "batch", str(file), "--out", str(folder), "--quiet", *paths_from]
    words += [f"--limit-seconds={limit_seconds!r}", f"--limit-memory={limit_memory_mb!r}"]
    _call([*words, "--collect"])  # is every line a job, and which are done?
    lines = _lines_left(file, _verdicts(folder))
    with Shown(progress) as shown:
        if lines and client is not None:
            _run_lines(distributed, client, words, lines, shown)
        elif lines:
            # Threads that wait for processes: nothing of a caller's program is imported again, as in processes of Python's.
            threads = min(processes or _cores(), len(lines))
            cluster = distributed.LocalCluster(n_workers=1, threads_per_worker=threads, processes=False, dashboard_address=None, memory_limit=0)
            with cluster, distributed.Client(cluster) as own:
                _run_lines(distributed, own, words, lines, shown)
    _call([*words, "--collect"])
    return _verdicts(folder)


def _run_lines(distributed: Any, client: Any, words: list[str], lines: list[int], shown: ProgressCall | None) -> None:
    # pure=False: Dask is not to take the result of an earlier call for this one's.
    tasks = [client.submit(_call, [*words, "--jobs", "1", "--lines", str(line)], pure=False, priority=-line) for line in lines]
    try:
        for number, task in enumerate(distributed.as_completed(tasks), 1):
            if task.result() == _interrupted:
                raise KeyboardInterrupt
            if shown:
                shown("batch", number / len(tasks), None)
    except BaseException:
        client.cancel(tasks)
        _end_all()
        raise

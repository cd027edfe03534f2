"""Runs as folders: what the program writes, judges and draws."""

from __future__ import annotations

import base64
import html
import os
from types import TracebackType

from . import _toile
from ._errors import Error, InputError
from ._pictures import VIEW, ShowsItself
from ._progress import ProgressCall, Shown
from ._simulation import Simulation
from ._toile import CheckReport, Verdict

Path = str | os.PathLike[str]


class RunWriter(ShowsItself):
    """Writes frames of a simulation as files that other programs read (docs/reports.md), in a `with` block:

        with toile.RunWriter("out/walk", sim, fps=30) as run:
            for frame in sim.frames(seconds=4, fps=30):
                run.add()
        print(run.verdict.explain())

    A folder that was left by an exception says that it is not finished, and is no pass.  In a notebook it shows its last frame, and its verdict once
    it has one.
    """

    def __init__(self, folder: Path, simulation: Simulation, *, fps: float = 30) -> None:
        """Makes the folder, or replaces a run of Toile's there, and writes frame 0: the simulation as it is now.

        Raises IoError for files there that are not Toile's, and when another process writes there.
        """
        self._simulation = simulation
        self._folder = os.fspath(folder)
        self._drawn: tuple[int, bytes] = (0, b"")  # of how many frames the last one, as a PNG
        self._core: _toile.RunWriter | None = _toile.RunWriter(os.fspath(folder), simulation._core, fps)
        self._frames = 0  # of a run that is finished
        self._verdict: Verdict | None = None

    def add(self) -> None:
        """The next frame: the simulation as it is now."""
        if self._core is None:
            raise Error("RunWriter.add: the run is finished")
        self._core.add(self._simulation._core)

    @property
    def frames(self) -> int:
        """How many are written."""
        return self._frames if self._core is None else self._core.frames

    def finish(self) -> Verdict:
        """Writes the report; nothing can be added then.  The end of the `with` block does it too."""
        if self._core is not None:
            self._verdict = self._core.finish()
            self._let_go()
        if self._verdict is None:
            raise Error("RunWriter.finish: an exception has ended this run")
        return self._verdict

    def _let_go(self) -> None:  # of the folder, which others may read and draw then
        if self._core is not None:
            self._frames, self._core = self._core.frames, None

    @property
    def verdict(self) -> Verdict | None:
        """What finish() returned; None before."""
        return self._verdict

    def __repr__(self) -> str:
        return f"<RunWriter of {self._folder}, {self.frames} frames>"

    def _still(self) -> bytes:
        if self._drawn[0] != self.frames:
            self._drawn = self.frames, _toile.picture_of_run(self._folder, **VIEW)
        return self._drawn[1]

    def _repr_html_(self) -> str | None:
        if (missing := super()._repr_html_()) is not None:
            return missing
        told = repr(self) if self._verdict is None else self._verdict.explain()
        return f'<img src="data:image/png;base64,{base64.b64encode(self._still()).decode()}"><pre>{html.escape(told)}</pre>'

    def __enter__(self) -> RunWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if kind is None:
            self.finish()
        self._let_go()


def run_scene(
    path: Path, folder: Path, *, threads: int = 0, time_limit_s: float = 0, progress: bool | ProgressCall | None = None
) -> Verdict:
    """A scene file from beginning to end, into a folder; time_limit_s is wall time that dressing may take, 0: any.

    After a KeyboardInterrupt `toile resume` goes on with it.  Raises IoError and InputError.
    """
    with Shown(progress) as call:
        return _toile.run_scene(os.fspath(path), os.fspath(folder), threads, time_limit_s, call)


def verify(folder: Path) -> Verdict:
    """Reads and measures every frame of a run's folder (docs/theory/verify.md).  Raises IoError and InputError."""
    return _toile.verify(os.fspath(folder))


def check_pattern(path: Path) -> CheckReport:
    """What is wrong with a sewing pattern, or probably not meant; simulates nothing.  Raises IoError."""
    return _toile.check_pattern(os.fspath(path))


def export_run(folder: Path, out: Path, *, to: str = "", of: str = "cloth", frame: int | None = None, all: bool = False) -> list[str]:
    """Frames of a run's folder as files for other programs; returns what was written.

    to     "obj", "ply" or "gltf"; empty: by the ending of `out`
    of     "cloth" or "body"
    frame  which one; None: the last
    all    every frame, in numbered files of the folder `out`

    Panels keep their names; vertices of a seam are split where the format has one uv for each.
    """
    if frame is not None and frame < 0:
        raise InputError(f"frame: expected a number from 0, got {frame}")
    return _toile.export_run(os.fspath(folder), os.fspath(out), to, of, -1 if frame is None else frame, all)


def preview(folder: Path) -> None:
    """Draws preview.png and preview.mp4 of a run's folder.  Raises Error where Toile was built without pictures."""
    _toile.preview(os.fspath(folder))

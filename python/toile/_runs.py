"""Run folders, as the program writes, judges and draws them."""

from __future__ import annotations

import base64
import html
import os
import tempfile
from collections.abc import Sequence
from types import TracebackType
from typing import Literal

from . import _toile
from ._errors import Error, InputError, IoError
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

    After an exception the folder is marked as unfinished, which is no pass.  In a notebook it shows its last frame, and its verdict once it has
    one.
    """

    def __init__(self, folder: Path, simulation: Simulation, *, fps: float = 30) -> None:
        """Makes the folder, or replaces a run of Toile's there, and writes frame 0, the simulation's present state.

        Raises IoError for files there that are not Toile's, and when another process writes there.
        """
        self._simulation = simulation
        self._folder = os.fspath(folder)
        self._drawn: tuple[int, bytes] = (0, b"")  # number of frames when drawn, the last one as a PNG
        self._core: _toile.RunWriter | None = _toile.RunWriter(os.fspath(folder), simulation._core, fps)
        self._frames = 0  # of a run that is finished
        self._verdict: Verdict | None = None

    def add(self) -> None:
        """Writes the next frame, the simulation's present state."""
        if self._core is None:
            raise Error("RunWriter.add: the run is finished")
        self._core.add(self._simulation._core)

    @property
    def frames(self) -> int:
        """The number of frames written."""
        return self._frames if self._core is None else self._core.frames

    def finish(self) -> Verdict:
        """Writes the report; no frame can be added afterwards.  The end of the `with` block does it too."""
        if self._core is not None:
            self._verdict = self._core.finish()
            self._let_go()
        if self._verdict is None:
            raise Error("RunWriter.finish: an exception has ended this run")
        return self._verdict

    def _let_go(self) -> None:  # releases the folder, which others may then read and draw
        if self._core is not None:
            self._frames, self._core = self._core.frames, None

    @property
    def verdict(self) -> Verdict | None:
        """The result of finish(); None before."""
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
    """Runs a scene file to its end, into a folder; time_limit_s is wall time that dressing may take, 0: no limit.

    After a KeyboardInterrupt `toile resume` continues it.  Raises IoError and InputError.
    """
    with Shown(progress) as call:
        return _toile.run_scene(os.fspath(path), os.fspath(folder), threads, time_limit_s, call)


def verify(folder: Path) -> Verdict:
    """Reads and measures every frame of a run folder (docs/theory/verify.md).  Raises IoError and InputError."""
    return _toile.verify(os.fspath(folder))


def check_pattern(path: Path) -> CheckReport:
    """Checks a sewing pattern for errors and for input that is probably not meant; simulates nothing.  Raises IoError."""
    return _toile.check_pattern(os.fspath(path))


def export_run(folder: Path, out: Path, *, to: str = "", of: str = "cloth", frame: int | None = None, all: bool = False) -> list[str]:
    """Writes frames of a run folder as files for other programs; returns their paths.

    to     "obj", "ply", "gltf", "usda", "pc2" or "mdd"; empty: by the file extension of `out`, which may also be .usdc
    of     "cloth", "body", or of USD "both"
    frame  which one; None: the last, and of usda, usdc, pc2 and mdd all in one file
    all    every frame, in numbered files of the folder `out`, or in one file `out` that ends in .glb

    Panels keep their names; vertices of a seam are split where the format has one uv per vertex.  A .usdc is made by usd-core (pip install
    usd-core); without it that is an ImportError.
    """
    if os.fspath(out).endswith(".usdc"):
        return [_usdc(folder, out, of, frame)]
    if frame is not None and frame < 0:
        raise InputError(f"frame: expected a number from 0, got {frame}")
    return _toile.export_run(os.fspath(folder), os.fspath(out), to, of, -1 if frame is None else frame, all)


def _usdc(folder: Path, out: Path, of: str, frame: int | None) -> str:
    """Through the text form, which holds the same numbers; the file appears when it is complete."""
    try:
        from pxr import Sdf
    except ImportError as error:
        raise ImportError("a .usdc file is written by usd-core: pip install usd-core, or write .usda") from error
    target = os.fspath(out)
    os.makedirs(os.path.dirname(target) or ".", exist_ok=True)
    with tempfile.TemporaryDirectory(dir=os.path.dirname(target) or ".") as beside:
        (text,) = export_run(folder, os.path.join(beside, "run.usda"), of=of, frame=frame)
        binary = os.path.join(beside, "run.usdc")
        if not Sdf.Layer.FindOrOpen(text).Export(binary):
            raise IoError(f"{target}: usd-core could not write it")
        os.replace(binary, target)
    return target


def preview(
    folder: Path,
    *,
    style: Literal["technical", "studio"] = "technical",
    close_up_m: Sequence[float] | None = None,
    turntable: bool = False,
    film: bool = True,
    looks: Path | None = None,
) -> None:
    """Draws preview.png and preview.mp4 into a run folder.

    `style`: "technical" shows cloth as simulated, with a grid along its threads; "studio" smooth, thick, woven and sewn.
    `close_up_m` (3,): also close-up.png, 30 cm around this point in the last frame.  `turntable`: also turntable.mp4, once around the last frame.
    `film`: preview.mp4.  `looks`: a JSON file of colours and prints by panel, garment and fabric (docs/howto/preview.md).  Raises Error where Toile was
    built without pictures, InputError for another style, and for looks that are wrong or of panels, garments or fabrics that the run does not have."""
    point = None if close_up_m is None else tuple(map(float, close_up_m))
    _toile.preview(os.fspath(folder), style, point, turntable, film, "" if looks is None else os.fspath(looks))

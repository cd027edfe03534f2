"""The folder of a run: how far it is, its verdict, where cloth passes through something."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import point_cache
from .errors import ToileError

EXIT_OK, EXIT_FAILED, EXIT_INTERRUPTED = 0, 5, 8


def _json_of(path: Path) -> dict[str, Any]:
    try:
        value = json.loads(path.read_text())
    except FileNotFoundError:
        raise ToileError(f"{path} is not there: the run is not finished") from None
    except (OSError, ValueError) as error:
        raise ToileError(f"{path}: {error}") from None
    if not isinstance(value, dict):
        raise ToileError(f"{path}: expected an object of JSON, got {type(value).__name__}")
    return value


@dataclass
class Verdict:
    passed: bool
    line: str  # "pass", "fail: stretch, slid_off"
    details: list[str] = field(default_factory=list)
    ended: str = ""
    crossings: int = 0  # edges that pass through a triangle, in the worst frame

    @property
    def reached_its_end(self) -> bool:
        """Whatever was found wrong with it, all frames are there."""
        return self.ended in ("still", "time")


def verdict(run: Path) -> Verdict:
    report = _json_of(run / "report.json")
    passed = report.get("verdict") == "pass"
    codes = report.get("qualifications" if passed else "reasons", [])
    line = "pass" if passed else "fail"
    if codes:
        line += (", with reservations: " if passed else ": ") + ", ".join(codes)
    details = [*_sentences(report.get("reason_details")), *_sentences(report.get("qualification_details"))]
    details += [f"warning: {warning}" for warning in report.get("warnings", [])]
    counts = report.get("penetrations") or {}
    crossings = sum(counts.get(kind, {}).get("max", 0) for kind in ("cloth_body_edges", "cloth_cloth_edges"))
    return Verdict(passed, line, details, report.get("ended", ""), crossings)


def _sentences(details: Any) -> list[str]:
    if isinstance(details, dict):
        return [f"{code}: {text}" for code, text in details.items()]
    return [str(text) for text in details or []]


def rate(run: Path) -> float:
    """Frames per second, also of a run that was stopped."""
    for name in ("report.json", "unfinished.json"):
        if (run / name).exists():
            fps = _json_of(run / name).get("fps")
            if isinstance(fps, (int, float)) and fps > 0:
                return float(fps)
    raise ToileError(f"{run}: expected a folder of a run of Toile with report.json, got none with frames per second")


@dataclass
class Progress:
    words: str
    share: float | None = None  # None: nobody knows when it ends


def progress(run: Path, frames: int | None) -> Progress:
    """By the frames that the caches count.  `frames`: how many there will be; None: until it is still."""
    cloth = point_cache.samples_so_far(run / "cloth.pc2")
    if cloth == 0:
        sewn = point_cache.samples_so_far(run / "sewing.pc2")
        return Progress(f"sewing, {sewn / 30:.1f} s" if sewn else "preparing")  # 30 samples a second: docs/reports.md
    if frames is None:
        return Progress(f"draping, frame {cloth - 1}")
    return Progress(f"frame {cloth} of {frames}", min(cloth / frames, 1.0))


@dataclass
class Crossings:
    frame: int = -1  # that with most of them; -1: there is none
    vertices: list[int] = field(default_factory=list)  # of the cloth


def crossings(audit: Path, cloth_triangles: list[tuple[int, int, int]]) -> Crossings:
    """From the answer of `toile verify --json`."""
    text = _json_of(audit)
    frame = text.get("worst_frame")
    if frame is None:
        return Crossings()
    found: set[int] = set()
    for crossing in text.get("worst_frame_crossings", []):
        if crossing["edge_of"] == "cloth":
            found.update(crossing["edge"])
        if crossing["triangle_of"] == "cloth":
            found.update(cloth_triangles[crossing["triangle"]])
    return Crossings(int(frame), sorted(found))

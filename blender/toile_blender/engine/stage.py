"""The folder of one stage (dress, motion): its inputs, the run that is made of them, and whether there is one already."""

from __future__ import annotations

import filecmp
import hashlib
import json
import shutil
from pathlib import Path
from typing import Any

from . import scene_file
from .errors import ToileError


class Stage:
    """inputs/ (scene.json and the meshes beside it), run/ (Toile's), cache.pc2 (the same positions for the object in Blender), particles.npy.

    New inputs are made beside the old ones, and take their place when they are complete and differ."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.inputs, self.run = folder / "inputs", folder / "run"
        self.new_inputs = folder / "inputs.new"
        self.cache, self.particles = folder / "cache.pc2", folder / "particles.npy"
        self._same = False
        self.output, self.audit = folder / "output.txt", folder / "audit.json"

    def begin_inputs(self) -> Path:
        try:
            shutil.rmtree(self.new_inputs, ignore_errors=True)
            self.new_inputs.mkdir(parents=True)
        except OSError as error:
            raise ToileError(f"cannot write to {self.folder}: {error.strerror}") from None
        return self.new_inputs

    def end_inputs(self, scene: dict[str, Any], options: list[str], program: str, files: list[Path]) -> None:
        """`options` of the run and `program` with its version belong to what it is made of; so do `files` outside that the scene names."""
        scene_file.write(self.new_inputs / "scene.json", scene)
        made_of = {"program": program, "options": options, "files": [_checksum(file) for file in files]}
        (self.new_inputs / "made_of.json").write_text(json.dumps(made_of, indent=1) + "\n")
        self._same = _same(self.inputs, self.new_inputs)
        shutil.rmtree(self.new_inputs if self._same else self.inputs, ignore_errors=True)
        if not self._same:
            self.new_inputs.rename(self.inputs)
            for file in (self.audit, self.cache, self.particles):
                file.unlink(missing_ok=True)

    def command(self, options: list[str], threads: int) -> list[str]:
        """What is left to do: nothing (empty) where the run was made of just this and is finished; to go on, where it was stopped."""
        stopped = (self.run / "unfinished.json").exists()
        more = ["--threads", str(threads), "--no-preview", "--quiet"]
        if self._same and not stopped and (self.run / "report.json").is_file():
            return []
        if self._same and stopped and (self.run / "checkpoint.bin").is_file():
            return ["resume", str(self.run), *more]
        return ["run", str(self.inputs / "scene.json"), "--out", str(self.run), *options, *more]


def _checksum(file: Path) -> str:
    try:
        return hashlib.sha256(file.read_bytes()).hexdigest()
    except OSError as error:
        raise ToileError(f"cannot read {file}: {error.strerror}") from None


def _same(a: Path, b: Path) -> bool:
    names = sorted(path.name for path in a.glob("*")) if a.is_dir() else []
    if names != sorted(path.name for path in b.glob("*")):
        return False
    return not any(filecmp.cmpfiles(a, b, names, shallow=False)[1:])

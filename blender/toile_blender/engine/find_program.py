"""Where the program `toile` is: the path of the preferences, then PATH, then the one that came with the add-on."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
from pathlib import Path

from .errors import ToileError

_NAME = "toile.exe" if os.name == "nt" else "toile"
bundled = Path(__file__).parent.parent / "bin" / _NAME
_ANSWER_S = 20  # how long --version may take: a disk that wakes up


def find(preferred: str = "", search_path: str | None = None, carried: Path = bundled) -> Path:
    """`preferred`: a file, or a folder that has it.  An empty one is looked for; one that is not there is an error, and nothing else is tried."""
    if preferred:
        path = Path(preferred).expanduser().absolute()  # it is started from another folder
        if path.is_dir():
            path /= _NAME
        if not path.is_file():
            raise ToileError(f"the program of the preferences is not there: {path}. Correct it, or leave it empty to look for `toile` in PATH")
        if not os.access(path, os.X_OK):
            raise ToileError(f"{path} may not be executed: is it the program `toile`?")
        return path
    found = shutil.which(_NAME, path=search_path)
    if found:
        return Path(found).absolute()
    if carried.is_file():
        _make_executable(carried)
        return carried
    raise ToileError(
        f"the program `toile` is not in PATH, and this add-on carries none ({carried}). Build it (`make build` in the folder of Toile), "
        "then name build/release/toile in the preferences of the add-on"
    )


def _make_executable(path: Path) -> None:
    """Installing an add-on from a zip file drops the permission."""
    if not os.access(path, os.X_OK):
        path.chmod(path.stat().st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)


def version(program: Path) -> str:
    try:
        done = subprocess.run([program, "--version"], capture_output=True, text=True, errors="replace", timeout=_ANSWER_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ToileError(f"{program} does not run: {error}") from None
    if done.returncode != 0:
        raise ToileError(f"{program} does not run: {done.stderr.strip() or f'exit code {done.returncode}'}")
    return done.stdout.strip()

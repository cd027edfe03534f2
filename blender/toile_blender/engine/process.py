"""One process of the program `toile`: begun, asked whether it has ended, stopped."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

from .errors import ToileError

_POLITE_S = 3.0  # Toile ends within a second of an interrupt; a slow disk gets some more


class Process:
    """Output goes to files, so that nothing waits for a full pipe: `errors` has what the program says to the user."""

    def __init__(self, program: Path, arguments: list[str], folder: Path, output: Path) -> None:
        self._errors = output.with_suffix(".errors.txt")
        with open(output, "wb") as out, open(self._errors, "wb") as errors:
            try:
                self._process = subprocess.Popen([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=errors)
            except OSError as error:
                raise ToileError(f"{program} does not run: {error.strerror or error}") from None

    @property
    def pid(self) -> int:
        return self._process.pid

    def exit_code(self) -> int | None:
        """None while it runs."""
        return self._process.poll()

    def errors(self) -> str:
        text = self._errors.read_text(errors="replace") if self._errors.exists() else ""
        return "\n".join(line.removeprefix("toile: ") for line in text.strip().splitlines())

    def interrupt(self) -> None:
        """Asks it to end with consistent files, as Ctrl-C does; does not wait."""
        if self._process.poll() is None:
            if os.name == "nt":
                self._process.terminate()
            else:
                self._process.send_signal(signal.SIGINT)

    def stop(self) -> None:
        """It is gone when this returns."""
        self.interrupt()
        try:
            self._process.wait(_POLITE_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

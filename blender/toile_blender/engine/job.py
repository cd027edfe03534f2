"""Work that lasts: a generator that is taken a little further whenever there is time, and the process that it waits for."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Callable, Generator, Iterator

from . import run_files
from .errors import ToileError
from .process import Process
from .run_files import Progress

_PATIENCE_S = 3.0  # after an interrupt, before the process is killed
_PAUSE_S = 0.05  # between two looks at the process, where nothing else has to be done


class Waiting(Progress):
    """Nothing to do until the process has gone on."""


class Job:
    """`steps(job)` yields how far it is.  Stop while a process runs: the process ends with whole files and the steps go on with what there is;
    stop at any other time: the steps end at once."""

    def __init__(self, steps: Callable[[Job], Generator[Progress, None, None]]) -> None:
        self.progress = Progress("preparing")
        self.stopped = False
        self.error = ""
        self.done = False
        self._steps: Iterator[Progress] = steps(self)
        self._process: Process | None = None
        self._kill_at = 0.0

    @property
    def pid(self) -> int | None:
        return self._process.pid if self._process else None

    def tick(self, budget_s: float = 0.05) -> bool:
        """Goes on for about that long, at least one step.  False: it is over; `error` has what went wrong."""
        until = time.monotonic() + budget_s
        if self._kill_at and self._process and time.monotonic() > self._kill_at:
            self._process.stop()
        while not self.done:
            try:
                self.progress = next(self._steps)
            except StopIteration:
                self._end()
            except ToileError as error:
                self._end(str(error))
            except BaseException:
                self._end("an error of the add-on: the console has it")
                raise
            if isinstance(self.progress, Waiting) or time.monotonic() >= until:
                break
        return not self.done

    def finish(self) -> None:
        """For scripts: returns when it is over."""
        while self.tick():
            if isinstance(self.progress, Waiting):
                time.sleep(_PAUSE_S)

    def stop(self) -> None:
        """Does not wait."""
        self.stopped = True
        if self._process is None:
            self._end()
        else:
            self._process.interrupt()
            self._kill_at = time.monotonic() + _PATIENCE_S

    def abandon(self) -> None:
        """Nothing of it is left running when this returns."""
        self.stopped = True
        self._end()

    def _end(self, error: str = "") -> None:
        self.done, self.error = True, error
        if self._process is not None:
            self._process.stop()
            self._process = None
        close = getattr(self._steps, "close", None)
        if close is not None:
            close()

    def run(self, program: Path, arguments: list[str], folder: Path, output: Path, watch: Callable[[], Progress]) -> Generator[Progress, None, int]:
        """The exit code of the program: 0, 5 (it failed, and its files say why) or 8 (it was stopped); anything else is an error in its words."""
        process = self._process = Process(program, arguments, folder, output)
        while (code := process.exit_code()) is None:
            seen = watch()
            yield Waiting("stopping" if self.stopped else seen.words, seen.share)
        self._process = None
        if self.stopped:
            return run_files.EXIT_INTERRUPTED
        if code in (run_files.EXIT_OK, run_files.EXIT_FAILED, run_files.EXIT_INTERRUPTED):
            return code
        raise ToileError(process.errors() or f"{program.name} ended with exit code {code}")

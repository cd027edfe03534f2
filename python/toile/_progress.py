"""The progress of dress(), on a terminal or in a notebook."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Any, Callable, Union

# phase, share of it (0 ... 1), seconds left of it or None
ProgressCall = Callable[[str, float, Union[float, None]], Any]


class TextBar:
    """One line of text that is overwritten, for every terminal and every notebook."""

    width = 30

    def __init__(self, stream: Any = None) -> None:
        self._stream = stream or sys.stderr
        self._length = 0
        self._phase = ""

    def __call__(self, phase: str, share: float, seconds_left: float | None) -> None:
        if self._phase and phase != self._phase:
            self._stream.write("\n")
            self._length = 0
        self._phase = phase
        filled = round(self.width * min(max(share, 0.0), 1.0))
        left = "" if seconds_left is None else f", {seconds_left:.0f} s left"
        line = f"{phase:>12} [{'#' * filled}{'.' * (self.width - filled)}] {100 * share:3.0f} %{left}"
        self._stream.write("\r" + line.ljust(self._length))
        self._stream.flush()
        self._length = len(line)

    def close(self) -> None:
        if self._phase:
            self._stream.write("\n")
            self._stream.flush()


class TqdmBar:
    """The same by tqdm, where it is installed."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm, self._phase = tqdm, ""
        self._bar: Any = None

    def __call__(self, phase: str, share: float, seconds_left: float | None) -> None:
        if phase != self._phase:
            self.close()
            self._phase = phase
            self._bar = self._tqdm(total=100, desc=phase, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
        self._bar.update(round(100 * share) - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None


def _bar() -> TextBar | TqdmBar:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return TextBar()
    return TqdmBar(tqdm)


class Shown:
    """`progress` as it was given to a call: None or False, True for a bar, or a callable."""

    def __init__(self, progress: bool | ProgressCall | None) -> None:
        if progress is not None and not isinstance(progress, bool) and not callable(progress):
            raise TypeError(f"progress: expected True or what can be called, got {type(progress).__name__}")
        self._bar = _bar() if progress is True else None
        self.call: ProgressCall | None = self._bar or (progress if callable(progress) else None)

    def __enter__(self) -> ProgressCall | None:
        return self.call

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._bar is not None:
            self._bar.close()

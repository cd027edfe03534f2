"""Caches the values read from a simulation until it moves."""

from __future__ import annotations

from typing import Any, Callable, TypeVar

T = TypeVar("T")


class Reads:
    def __init__(self) -> None:
        self._kept: dict[str, Any] = {}

    def once(self, what: str, read: Callable[[], T]) -> T:
        if what not in self._kept:
            self._kept[what] = read()
        kept: T = self._kept[what]
        return kept

    def changing(self, what: tuple[str, ...]) -> Changing:
        return Changing(self._kept, what)


class Changing:
    """Around a call: drops the named values from the cache, however the call ends; without names all."""

    def __init__(self, kept: dict[str, Any], what: tuple[str, ...]) -> None:
        self._kept, self._what = kept, what

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_: Any) -> None:
        for what in self._what or tuple(self._kept):
            self._kept.pop(what, None)

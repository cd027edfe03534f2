"""Values that keep the recipe of their making, which is pickled, and followed again when they are unpickled."""

from __future__ import annotations

import os
from typing import Any, ClassVar, TypeVar

Self = TypeVar("Self", bound="Made")
Call = tuple[str, dict[str, Any]]


class Made:
    """A core object with the call that made it, and the calls that changed it since."""

    _core_type: ClassVar[type]
    _core: Any
    _calls: list[Call]

    @classmethod
    def _make(cls: type[Self], how: str, **arguments: Any) -> Self:
        made = object.__new__(cls)
        made._begin(how, **arguments)
        return made

    def _begin(self, how: str, **arguments: Any) -> None:
        self._core = getattr(self._core_type, how)(**arguments)
        self._calls = [(how, arguments)]

    def _change(self: Self, how: str, **arguments: Any) -> Self:
        getattr(self._core, how)(**arguments)
        self._calls.append((how, arguments))
        return self

    def __copy__(self: Self) -> Self:
        made = object.__new__(type(self))
        made._core, made._calls = self._core_type(self._core), list(self._calls)
        return made

    def __deepcopy__(self: Self, memo: Any) -> Self:
        return self.__copy__()  # the arguments of the calls are immutable

    def __getstate__(self) -> list[Call]:
        return self._calls

    def __setstate__(self, calls: list[Call]) -> None:
        (how, arguments), *changes = calls
        self._begin(how, **arguments)
        for how, arguments in changes:
            self._change(how, **arguments)


def file_path(path: str | os.PathLike[str]) -> str:
    """The absolute path, independent of later changes of the working directory."""
    return os.path.abspath(os.fspath(path))

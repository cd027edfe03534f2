"""Arrays as the library reads them: numbers of one type, C-contiguous, of a shape that the error names."""

from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import InputError

Dimension = Union[str, int]


def _shape(dimensions: Sequence[Dimension]) -> str:
    return "(" + ", ".join(str(d) for d in dimensions) + ("," if len(dimensions) == 1 else "") + ")"


def _fits(shape: tuple[int, ...], dimensions: Sequence[Dimension]) -> bool:
    return len(shape) == len(dimensions) and all(isinstance(d, str) or d == n for n, d in zip(shape, dimensions))


def _read(value: ArrayLike, name: str, kinds: str, what: str, shapes: Sequence[Sequence[Dimension]]) -> NDArray[Any]:
    expected = " or ".join(_shape(s) for s in shapes)
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        raise InputError(f"{name}: expected {what} of shape {expected}, got rows of different lengths") from None
    empty = array.size == 0 and not isinstance(value, np.ndarray)  # [] has no type of its own
    if array.dtype.kind not in kinds and not empty:
        raise TypeError(f"{name}: expected {what} of shape {expected}, got {array.dtype} in {_shape(array.shape)}")
    if not any(_fits(array.shape, s) for s in shapes):
        raise InputError(f"{name}: expected {what} of shape {expected}, got {_shape(array.shape)}")
    return array


def numbers(value: ArrayLike, name: str, *shapes: Sequence[Dimension]) -> NDArray[np.float64]:
    """float64 of one of the shapes; a word in a shape stands for any number.  Not copied if it has that form already."""
    return np.ascontiguousarray(_read(value, name, "fiu", "numbers", shapes), dtype=np.float64)


def integers(value: ArrayLike, name: str, *shapes: Sequence[Dimension]) -> NDArray[np.int32]:
    """int32 of one of the shapes."""
    array = _read(value, name, "iu", "integers", shapes)
    if array.size and (array.min() < -(2**31) or array.max() >= 2**31):
        raise InputError(f"{name}: expected integers of 32 bits, got {array.min()} to {array.max()}")
    return np.ascontiguousarray(array, dtype=np.int32)


def point(value: ArrayLike, name: str) -> tuple[float, float, float]:
    x, y, z = numbers(value, name, (3,)).tolist()
    return (x, y, z)


def own(array: NDArray[Any]) -> NDArray[Any]:
    """A read-only copy."""
    array = array.copy()
    array.flags.writeable = False
    return array

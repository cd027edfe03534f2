"""PC2 point caches: "POINTCACHE2\\0", int32 version 1, int32 points, float start, float rate, int32 samples; then float32 xyz, little-endian."""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import BinaryIO

import numpy as np

from .errors import ToileError

_HEADER = struct.Struct("<12siiffi")
_MAGIC = b"POINTCACHE2\0"


def header(path: Path) -> tuple[int, int]:
    """(points, samples)."""
    with open(path, "rb") as file:
        data = file.read(_HEADER.size)
    if len(data) < _HEADER.size or data[:12] != _MAGIC:
        raise ToileError(f"{path}: expected a PC2 point cache, got {data[:12]!r}")
    _, version, points, _, _, samples = _HEADER.unpack(data)
    if version != 1 or points < 0 or samples < 0:
        raise ToileError(f"{path}: expected version 1 and counts from 0, got version {version}, {points} points, {samples} samples")
    return points, samples


def samples_so_far(path: Path) -> int:
    """Of a cache that may be growing, or not be there yet."""
    try:
        return header(path)[1]
    except (OSError, ToileError):
        return 0


class Reader:
    """One sample at a time, so that a long cache needs no memory."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.points, self.samples = header(path)
        expected = _HEADER.size + 12 * self.points * self.samples
        size = os.path.getsize(path)
        if size < expected:  # a killed writer leaves more, never less
            raise ToileError(f"{path}: expected {expected} bytes for {self.samples} samples of {self.points} points, got {size}")

    def sample(self, number: int) -> np.ndarray:
        """(points, 3), float32."""
        if not 0 <= number < self.samples:
            raise ToileError(f"{self.path}: expected a sample from 0 to {self.samples - 1}, got {number}")
        count = 3 * self.points
        values = np.fromfile(self.path, dtype="<f4", count=count, offset=_HEADER.size + 4 * count * number)
        return values.reshape(-1, 3)


class Writer:
    """The file appears under its name when it is complete: `with Writer(...) as cache: cache.add(positions)`."""

    def __init__(self, path: Path, points: int) -> None:
        self.path, self.points, self.samples = path, points, 0
        self._partial = path.with_name(path.name + ".partial")
        self._file: BinaryIO = open(self._partial, "wb")
        self._write_header()

    def _write_header(self) -> None:
        self._file.seek(0)
        self._file.write(_HEADER.pack(_MAGIC, 1, self.points, 0.0, 1.0, self.samples))

    def add(self, positions: np.ndarray) -> None:
        if positions.shape != (self.points, 3):
            raise ToileError(f"{self.path}: expected {self.points} points in sample {self.samples}, got {len(positions)}")
        self._file.seek(0, os.SEEK_END)
        self._file.write(np.ascontiguousarray(positions, dtype="<f4").tobytes())
        self.samples += 1

    def close(self) -> None:
        self._write_header()
        self._file.close()
        os.replace(self._partial, self.path)

    def drop(self) -> None:
        """Leaves nothing."""
        self._file.close()
        self._partial.unlink(missing_ok=True)

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        self.close() if kind is None else self.drop()

"""Pins that follow sampled paths: their positions in time, and the times at which an advance() has to stop for a sample."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

_SAME_TIME_S = 1e-9  # far above the rounding of an hour of frames that are added up, far below any step


@dataclass
class _Path:
    particles: NDArray[np.int32]
    samples_m: NDArray[np.float64]  # (samples, particles, 3)
    fps: float
    from_s: float

    def at(self, t_s: float) -> NDArray[np.float64]:
        last = len(self.samples_m) - 1
        place = min(max((t_s - self.from_s) * self.fps, 0.0), float(last))
        nearest = round(place)
        if abs(place - nearest) <= _SAME_TIME_S * self.fps:
            return self.samples_m[nearest]
        k = int(place)
        share = place - k
        return (1 - share) * self.samples_m[k] + share * self.samples_m[min(k + 1, last)]

    def sample_times(self, begin_s: float, end_s: float) -> Iterator[float]:
        first = math.floor((begin_s - self.from_s) * self.fps)
        for k in range(max(first, 0), len(self.samples_m)):
            t_s = self.from_s + k / self.fps
            if t_s >= end_s:
                return
            yield t_s


class Paths:
    def __init__(self) -> None:
        self._paths: list[_Path] = []

    def add(self, particles: NDArray[np.int32], samples_m: NDArray[np.float64], fps: float, from_s: float) -> None:
        self._paths.append(_Path(particles, samples_m, fps, from_s))

    def drop(self, particles: Iterable[int]) -> None:
        gone = np.asarray(list(particles), dtype=np.int32)
        self._filter(lambda path: ~np.isin(path.particles, gone))

    def keep(self, pinned: Iterable[int], t_s: float) -> None:
        """Keeps the paths of pinned particles that have begun."""
        held = np.asarray(list(pinned), dtype=np.int32)
        self._paths = [path for path in self._paths if path.from_s <= t_s + _SAME_TIME_S]
        self._filter(lambda path: np.isin(path.particles, held))

    def _filter(self, stays) -> None:  # type: ignore[no-untyped-def]
        left = []
        for path in self._paths:
            mask = stays(path)
            if mask.any():
                left.append(_Path(path.particles[mask], path.samples_m[:, mask], path.fps, path.from_s))
        self._paths = left

    def parts(self, begin_s: float, h_s: float) -> list[tuple[float, float]]:
        """(end, length) of the parts of an advance(), none of which has a sample within it."""
        end_s = begin_s + h_s
        if not self._paths or not math.isfinite(end_s) or h_s <= 0:
            return [(end_s, h_s)]  # the library reports the error in h_s
        stops = sorted(t for path in self._paths for t in path.sample_times(begin_s, end_s))
        ends: list[float] = []
        for t in stops:
            if t - (ends[-1] if ends else begin_s) > _SAME_TIME_S and end_s - t > _SAME_TIME_S:
                ends.append(t)
        if not ends:
            return [(end_s, h_s)]
        begins = [begin_s, *ends]
        return [(b, b - a) for a, b in zip(begins, [*ends, end_s])]

    def at(self, t_s: float) -> Iterator[tuple[NDArray[np.int32], NDArray[np.float64]]]:
        for path in self._paths:
            yield path.particles, np.ascontiguousarray(path.at(t_s))

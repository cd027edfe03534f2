"""Many simulations at once."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor, wait
from typing import Callable, Iterable, TypeVar

import numpy as np
from numpy.typing import NDArray

from ._errors import InputError
from ._simulation import Simulation
from ._toile import DressReport, StepReport

T = TypeVar("T")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Batch:
    """Simulations that advance in parallel, each on one thread, with the same bits as one after the other.

    Make them with threads=1: with more they would compete for the cores.
    """

    def __init__(self, simulations: Iterable[Simulation], *, threads: int = 0) -> None:
        """threads: the number of simulations that run at once; 0: one per core."""
        self.simulations = list(simulations)
        for one in self.simulations:
            if not isinstance(one, Simulation):
                raise TypeError(f"simulations: expected toile.Simulation objects, got {type(one).__name__}")
        if len({id(one) for one in self.simulations}) < len(self.simulations):
            raise InputError("simulations: expected each one once")
        if threads < 0:
            raise InputError(f"threads: expected 0 or more, got {threads}")
        self._threads = threads or _cores()

    def advance(self, h_s: float) -> list[StepReport]:
        """Advances each by exactly h_s."""
        return self._each(lambda one: one.advance(h_s))

    def dress(self, longest_s: float = 20, time_limit_s: float = 0) -> list[DressReport]:
        """Dresses each."""
        return self._each(lambda one: one.dress(longest_s, time_limit_s))

    @property
    def positions_m(self) -> list[NDArray[np.float64]]:
        """(n, 3) of each."""
        return [one.positions_m for one in self.simulations]

    def __len__(self) -> int:
        return len(self.simulations)

    def __iter__(self):  # type: ignore[no-untyped-def]
        return iter(self.simulations)

    def _each(self, call: Callable[[Simulation], T]) -> list[T]:
        stop = False

        def unless_stopped(one: Simulation) -> T | None:
            return None if stop else call(one)

        with ThreadPoolExecutor(max_workers=max(1, min(self._threads, len(self)))) as pool:
            futures = [pool.submit(unless_stopped, one) for one in self.simulations]
            try:
                wait(futures)
            except BaseException:  # Ctrl-C arrives in the main thread, which waits here
                stop = True
                while wait(futures, timeout=0.05).not_done:  # one may have been about to start
                    for one in self.simulations:
                        one.cancel()
                raise
        return [future.result() for future in futures]  # type: ignore[misc]

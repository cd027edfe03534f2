"""One moment of a simulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._toile import StepReport


@dataclass(frozen=True, eq=False)
class Frame:
    """One moment.  Its arrays are read-only and its own: they stay as they are when the simulation goes on."""

    t_s: float
    positions_m: NDArray[np.float64]  # (n, 3)
    velocities_m_per_s: NDArray[np.float64]  # (n, 3)
    body_positions_m: NDArray[np.float64]  # (b, 3); (0, 3) without a body
    step: StepReport | None = None  # how it was reached

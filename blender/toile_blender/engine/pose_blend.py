"""From one pose into another, without a jump of velocity or acceleration at either end."""

from __future__ import annotations

import numpy as np


def shares(frames: int) -> np.ndarray:
    """Of the way, at frames 0 ... frames - 1; frame `frames` has all of it.  6 u^5 - 15 u^4 + 10 u^3, the path of least jerk."""
    u = np.arange(frames) / max(frames, 1)
    return u**3 * (10 - 15 * u + 6 * u**2)

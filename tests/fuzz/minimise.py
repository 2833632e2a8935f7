"""Fewer rows, and simpler numbers, that still fail.

A. Zeller, R. Hildebrandt: Simplifying and isolating failure-inducing input. IEEE Transactions on Software
Engineering 28, 2002.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

import numpy as np


def minimise(points: np.ndarray, fails: Callable[[np.ndarray], bool], seconds: float) -> np.ndarray:
    """A subset of the rows of points (n, d), for which ``fails`` holds as it does for all of them.

    No row can be left out, unless the time was too short to see.
    """
    until = time.monotonic() + seconds
    pieces = 2
    while len(points) > 1 and time.monotonic() < until:
        bounds = np.linspace(0, len(points), min(pieces, len(points)) + 1).astype(int)
        for i, j in itertools.pairwise(bounds):
            fewer = np.concatenate([points[:i], points[j:]])
            if len(fewer) and fails(fewer):
                points, pieces = fewer, max(2, pieces - 1)
                break
            if time.monotonic() > until:
                return points
        else:
            if pieces >= len(points):
                return points
            pieces = min(2 * pieces, len(points))
    return points

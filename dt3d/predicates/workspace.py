"""The workspace of the compiled predicates: what they know of the points, and where they compute.

The first entry is the *slack*, which every bound of a floating-point error gets added. The bounds are
relative to the greatest differences of coordinates, and hold if no operation under- or overflows. With
coordinates of at most 1 nothing overflows, and what underflows is off by 2^-1075: a predicate has less than
2^9 such errors, each times differences that multiply to at most 48. So a slack of 2^-1000 is enough for them,
and 2^-1000 G^5 for coordinates of at most G > 1. Beyond 2^200, where G^5 could overflow, the slack is
infinite: nothing is then decided in floating point.

Then come the addresses of the stages behind the filters (`open_stages`), as far as they are known, and of
what finds the others. Behind them is room for the integers of the exact stage.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .layout import INTEGERS_INDEX, SLACK_INDEX, WORKSPACE_SIZE

FACTORS = 1000  # exponents of powers of two that are doubles, and so are their reciprocals


def work_array(points: np.ndarray) -> np.ndarray:
    """Return what one thread's predicates of rows of ``points`` work in, float64 (WORKSPACE_SIZE,)."""
    from .open_stages import FUNCTIONS

    w = np.empty(WORKSPACE_SIZE)
    addresses = w.view(np.int64)
    addresses[SLACK_INDEX + 1 : INTEGERS_INDEX] = 0
    FUNCTIONS.write(addresses)
    greatest = float(np.abs(points).max(initial=1))
    w[SLACK_INDEX] = 2.0**-1000 * greatest**5 if greatest < 2.0**200 else np.inf
    return w


def scaled(points: npt.ArrayLike) -> np.ndarray:
    """Return points times a power of two, so that the greatest coordinate is about 1, where that is exact.

    It is unless that pushes the least one below 2^-1022; then the points themselves.

    Examples
    --------
    >>> from dt3d.predicates import scaled
    >>> scaled([[0.0, 6.0], [8.0, 1.0]]).tolist()
    [[0.0, 0.375], [0.5, 0.0625]]
    """
    return scaling(points)[0]


def scaling(points: npt.ArrayLike) -> tuple[np.ndarray, int]:
    """Return what `scaled` does, and the e with which that is points / 2^e."""
    points = np.asarray(points, np.float64)
    greatest = max(points.max(initial=0), -points.min(initial=0))
    exponent = int(np.frexp(greatest)[1])
    smaller = scaled_by(points, exponent)
    return (points, 0) if smaller is None else (smaller, exponent)


def scaled_by(points: np.ndarray, exponent: int) -> np.ndarray | None:
    """Return points / 2^exponent; None where that is not exact."""
    if not exponent:
        return points
    if abs(exponent) > FACTORS:
        with np.errstate(over="ignore"):
            smaller = np.ldexp(points, -exponent)
        exact = np.ldexp(smaller, exponent) == points
    else:  # the same, and ten times faster
        with np.errstate(over="ignore"):
            smaller = points * 2.0**-exponent
        exact = smaller * 2.0**exponent == points
    return smaller if exact.all() else None

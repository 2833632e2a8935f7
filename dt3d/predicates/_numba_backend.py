"""Signs of many cases by the compiled predicates, one after the other."""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit
from . import filtered, filtered2d
from .work import scaled, work_array


def signs(predicate: str, cases: np.ndarray) -> np.ndarray:
    """int8 (m,) of cases float64 (m, k, d)."""
    out = np.empty(len(cases), np.int8)
    cases = scaled(cases)
    _LOOPS[predicate](cases, work_array(cases), out)
    return out


@cached_njit
def _orient2d(cases, w, out):
    for i in range(len(out)):
        out[i] = filtered2d.orient2d(cases[i], 0, 1, 2, w)


@cached_njit
def _orient3d(cases, w, out):
    for i in range(len(out)):
        out[i] = filtered.orient3d(cases[i], 0, 1, 2, 3, w)


@cached_njit
def _in_circle(cases, w, out):
    for i in range(len(out)):
        out[i] = filtered2d.in_circle(cases[i], 0, 1, 2, 3, w)


@cached_njit
def _in_sphere(cases, w, out):
    for i in range(len(out)):
        out[i] = filtered.in_sphere(cases[i], 0, 1, 2, 3, 4, w)


_LOOPS = {"orient2d": _orient2d, "orient3d": _orient3d, "in_circle": _in_circle, "in_sphere": _in_sphere}

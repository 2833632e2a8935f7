"""Exact arithmetic with expansions: sums of doubles that do not overlap.

J. R. Shewchuk: Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. Discrete &
Computational Geometry 18, 1997, sections 2.3 to 2.5. An expansion lies in a work array as components of
increasing magnitude, none of them zero; zero has no components. The sign of an expansion is that of its last
component.

Compiled by numba without fast-math, so that no operation is contracted or reordered. Exact as long as no
product over- or underflows; `EXPONENTS` says which inputs that is promised for.
"""

from __future__ import annotations

import numba
import numpy as np

_SPLITTER = 2.0**27 + 1.0

# Doubles of a work array: enough for an in-sphere determinant of differences of two components each.
WORK = 1 << 18

# Coordinates that are zero or have all their bits between these powers of two never over- or underflow in an
# in-sphere determinant, a polynomial of degree 5 (with 53 bits to spare on either side for the splits).
EXPONENTS = (-190, 190)


@numba.njit(inline="always", cache=True)
def two_sum(a, b):
    """s + r = a + b exactly, s the rounded sum (Knuth)."""
    s = a + b
    virtual = s - a
    return s, (a - (s - virtual)) + (b - virtual)


@numba.njit(inline="always", cache=True)
def two_product(a, b):
    """p + r = a b exactly, p the rounded product (Dekker, Veltkamp)."""
    p = a * b
    c = _SPLITTER * a
    a_high = c - (c - a)
    a_low = a - a_high
    c = _SPLITTER * b
    b_high = c - (c - b)
    b_low = b - b_high
    return p, a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low)


@numba.njit(cache=True)
def _append(w, at, n, x):
    """Make x the next component of the expansion of length n at w[at], unless it is zero; the new length."""
    if x == 0.0:
        return n
    w[at + n] = x
    return n + 1


@numba.njit(cache=True)
def difference(w, at, a, b):
    """Put a - b at w[at]; returns its length, at most 2."""
    s, r = two_sum(a, -b)
    return _append(w, at, _append(w, at, 0, r), s)


@numba.njit(cache=True)
def add(w, e, ne, f, nf, h):
    """Put the sum of two expansions at w[h], apart from both; returns its length, at most ne + nf.

    Shewchuk's fast expansion sum with zero elimination: merge by magnitude, then carry upwards.
    """
    if ne == 0 or nf == 0:
        source, n = (f, nf) if ne == 0 else (e, ne)
        for i in range(n):
            w[h + i] = w[source + i]
        return n
    i = j = n = 0
    q = 0.0
    first = True
    while i < ne or j < nf:
        if j >= nf or (i < ne and abs(w[e + i]) < abs(w[f + j])):
            x = w[e + i]
            i += 1
        else:
            x = w[f + j]
            j += 1
        if first:
            q = x
            first = False
            continue
        q, r = two_sum(q, x)
        n = _append(w, h, n, r)
    return _append(w, h, n, q)


@numba.njit(cache=True)
def negate(w, e, ne):
    """Change the sign of an expansion in place."""
    for i in range(ne):
        w[e + i] = -w[e + i]


@numba.njit(cache=True)
def scale(w, e, ne, b, h):
    """Put b times an expansion at w[h], apart from it; returns its length, at most 2 ne."""
    if ne == 0 or b == 0.0:
        return 0
    q, r = two_product(w[e], b)
    n = _append(w, h, 0, r)
    for i in range(1, ne):
        p, low = two_product(w[e + i], b)
        q, r = two_sum(q, low)
        n = _append(w, h, n, r)
        q, r = two_sum(p, q)
        n = _append(w, h, n, r)
    return _append(w, h, n, q)


@numba.njit(cache=True)
def multiply(w, e, ne, f, nf, h):
    """Put the product of two expansions at w[h]; all from w[h] on is used. Length at most 2 ne nf."""
    if ne == 0 or nf == 0:
        return 0
    if nf > ne:
        e, ne, f, nf = f, nf, e, ne
    size = 2 * ne * nf
    other, term = h + size, h + 2 * size
    n = scale(w, e, ne, w[f], h)
    here = h
    for j in range(1, nf):
        m = scale(w, e, ne, w[f + j], term)
        there = other if here == h else h
        n = add(w, here, n, term, m, there)
        here = there
    if here != h:
        for i in range(n):
            w[h + i] = w[here + i]
    return n


def work_array() -> np.ndarray:
    """What one thread's exact predicates work in, float64 (WORK,)."""
    return np.empty(WORK)

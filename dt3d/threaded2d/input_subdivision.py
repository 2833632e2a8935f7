"""Which thread gets which sites (Kohout et al. 2004, section 4.5), and in which order it inserts them."""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit
from ..ordering.brio import brio
from ..ordering.hashing import mixed
from .configuration import Options

SUBDIVISIONS = ("random", "x-slabs", "distance", "curve")


@cached_njit(nogil=True)
def _shuffle(slots, seed):
    """R. A. Fisher and F. Yates: each is exchanged with one of those up to it, at random."""
    for i in range(len(slots) - 1, 0, -1):
        j = (mixed(i, seed) >> np.uint64(32)) * np.uint64(i + 1) >> np.uint64(32)
        slots[i], slots[j] = slots[j], slots[i]


def parts_of(points: np.ndarray, subdivision: str, parts: int, seed: int) -> np.ndarray:
    """The part of each site, 0 to parts - 1, of equal sizes up to one; int32 (n,).

    "random"; "x-slabs" by the first coordinate; "distance" from the origin of coordinates; "curve": stretches
    of the order of the rows, which is that of a space-filling curve where sites are inserted in that order.
    """
    n = len(points)
    slots = (np.arange(n) * parts // n).astype(np.int32)
    if parts == 1 or subdivision == "curve":
        return slots
    if subdivision == "random":
        _shuffle(slots, seed)
        return slots
    out = np.empty(n, np.int32)
    if subdivision == "x-slabs":
        out[np.argsort(points[:, 0], kind="stable")] = slots
    else:
        # of halves, since the distance itself may be beyond what float64 has
        out[np.argsort(np.hypot(points[:, 0] / 2, points[:, 1] / 2), kind="stable")] = slots
    return out


@cached_njit(nogil=True)
def _rotate(order, starts):
    """Let part k of m begin each of its rounds after k / m of it."""
    parts, rounds = starts.shape[0], starts.shape[1] - 1
    out = order.copy()
    for k in range(parts):
        for r in range(rounds):
            begin, end = starts[k, r], starts[k, r + 1]
            shift = (end - begin) * k // parts
            for i in range(begin, end):
                source = i + shift
                if source >= end:
                    source -= end - begin
                out[i] = order[source]
    return out


def insertion_order(points: np.ndarray, options: Options) -> tuple[np.ndarray, np.ndarray]:
    """All sites, part by part, int64 (n,), and the bounds of the parts, int64 (parts + 1,).

    In the order "brio" the points lie along the curve. Threads whose parts lie among each other begin each
    round at different places of it, so that they seldom meet; not with the batch method, where they change
    nothing and one warms the caches for the others.
    """
    parts, seed = options.parts, options.seed
    part = parts_of(points, options.subdivision, parts, seed)
    if options.order == "brio":
        sites, starts = brio(part, parts, seed)
        if options.method != "batch" and parts > 1 and options.subdivision != "curve":
            sites = _rotate(sites, starts)
        return sites, np.append(starts[:, 0], len(points))
    shuffled = np.random.default_rng([seed, 2]).permutation(len(points))
    sites = shuffled[np.argsort(part[shuffled], kind="stable")]
    return sites, np.searchsorted(part[sites], np.arange(parts + 1)).astype(np.int64)

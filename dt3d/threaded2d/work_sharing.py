"""Sites to insert: each thread its own part, and in the end what others have not come to.

The paper gives every thread a fixed part (Kohout et al. 2004, section 4.5). Where processors are not equally
fast, as those of a virtual machine, all then wait for the slowest. Here a thread takes its part in chunks,
and when nothing is left of it chunks of other parts. Small parts are one chunk. With fixed parts, on request,
a thread that has inserted its own ends.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .._numba.atomics import add, load, padded
from .._numba.kernel_cache import cached_njit
from . import columns as c

CHUNK = 512  # sites that a thread takes at a time

# columns of `parts`: where the sites begin that nobody has taken, and where the part ends
TAKEN, PART_END = range(2)


class Schedule(NamedTuple):
    """Which thread inserts which sites: the distribution of the work.

    Attributes
    ----------
    order : int64 (n,)
        Sites, part by part.
    parts : int64 (parts, 16)
    taker : int16 (n,)
        The thread that took each.
    fixed : bool
        Whether no thread takes sites of another's part.
    """

    order: np.ndarray
    parts: np.ndarray
    taker: np.ndarray
    fixed: bool


def share(order: np.ndarray, bounds: np.ndarray, *, fixed: bool = False) -> Schedule:
    """Sites in parts that begin at bounds[:-1] and end at bounds[1:]; one thread or more for all of them."""
    parts = padded(len(bounds) - 1)
    parts[:, TAKEN], parts[:, PART_END] = bounds[:-1], bounds[1:]
    return Schedule(order, parts, np.full(len(order), -1, np.int16), fixed)


def ahead_of_all(order: np.ndarray, bounds: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The order with the first ``count`` sites of each part in front of all parts, and the new bounds.

    There are ``bounds[0]`` sites in front.
    """
    parts = list(pairwise(bounds.tolist()))
    counts = [min(count, end - begin) for begin, end in parts]
    front = [order[begin : begin + c] for (begin, _), c in zip(parts, counts, strict=True)]
    rest = [order[begin + c : end] for (begin, end), c in zip(parts, counts, strict=True)]
    left = np.append(0, np.cumsum(counts[::-1]))[::-1]
    return np.concatenate(front + rest), bounds + left


@cached_njit
def next_chunk(state, schedule, me):
    """Take a chunk, the sites NEXT to CHUNK_END - 1 of the order: of its own part, then of others' if it may.

    Returns whether there was one.
    """
    parts = schedule.parts
    own = state[me, c.PART]
    for i in range(1 if schedule.fixed else len(parts)):
        part = (own + i) % len(parts)
        # the last chunks are left to the thread whose part it is, or that is at it
        left = parts[part, PART_END] - load(parts, (part, TAKEN))
        if left <= 0 or (i > 0 and left < 2 * CHUNK):
            continue
        begin = add(parts, (part, TAKEN), CHUNK)
        end = min(begin + CHUNK, parts[part, PART_END])
        if begin < end:
            state[me, c.NEXT], state[me, c.CHUNK_END], state[me, c.PART] = begin, end, part
            schedule.taker[begin:end] = me
            return True
    return False


@cached_njit(forceinline=True)
def next_site(mesh, schedule, me):
    """The next site of thread ``me``; -1 where there is none left for it."""
    state = mesh.state
    if state[me, c.NEXT] == state[me, c.CHUNK_END] and not next_chunk(state, schedule, me):
        return -1
    return schedule.order[state[me, c.NEXT]]

"""Sites that a thread has located ahead of their insertion: in hand.

By the time of its insertion a site's leaf may have been subdivided or flipped, by others or by the thread
itself; the location goes on from there. What the insertion will need is asked for before.
"""

from __future__ import annotations

import numpy as np

from ..._numba.kernel_cache import cached_njit
from ..in_place.walk import walk_history
from ..mesh import HINT, IN_HAND, NEXT, VISITED
from ..queue import ITEM_NODE, ITEM_SITE
from ..work_sharing import next_site
from .interleaved import EMPTY, LANE_NODE, LANE_SITE, LANES, advance, start
from .prefetch import prefetch_around, prefetch_beyond

AT_ONCE = 8


def empty_hands(threads: int) -> np.ndarray:
    """Sites and their leaves for each thread, and one that is helped: int64 (threads, AT_ONCE + 1, 2)."""
    return np.empty((threads, AT_ONCE + 1, 2), np.int64)


@cached_njit(forceinline=True)
def locate_one(points, nodes, state, sites, lanes, hands, me, walking, w):
    """Locate one more site of thread ``me``, into its hands; whether one was left."""
    if walking:
        q = next_site(state, sites, me)
        if q < 0:
            return False
        state[me, NEXT] += 1
        t, visited = walk_history(points, nodes, state[me, HINT], q, w)
        state[me, HINT] = t
    else:
        for i in range(LANES):
            if lanes[i, LANE_SITE] == EMPTY:
                q = next_site(state, sites, me)
                if q < 0:
                    break
                state[me, NEXT] += 1
                start(points, nodes, lanes, i, q, w)
        i, visited = advance(points, nodes, lanes, w)
        if i == EMPTY:
            return False
        q, t = lanes[i, LANE_SITE], lanes[i, LANE_NODE]
        lanes[i, LANE_SITE] = EMPTY
    state[me, VISITED] += visited
    at = state[me, IN_HAND]
    hands[at, ITEM_SITE], hands[at, ITEM_NODE] = q, t
    state[me, IN_HAND] = at + 1
    return True


@cached_njit(forceinline=True)
def prepare(points, nodes, hands, at, count):
    """Ask for what the insertions after that of hands[at] will need: first the surroundings of a site's leaf,
    then what lies beyond them."""
    if at + 2 < count:
        prefetch_around(points, nodes, hands[at + 2, ITEM_NODE])
    if at + 1 < count:
        prefetch_beyond(points, nodes, hands[at + 1, ITEM_NODE])

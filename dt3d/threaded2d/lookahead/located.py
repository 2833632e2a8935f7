"""Sites that a thread has located ahead of their insertion.

By the time of its insertion a site's leaf may have been subdivided or flipped, by others or by the thread
itself; the location goes on from there. What the insertion will need is loaded before.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..._numba.atomics import rows_apart
from ..._numba.kernel_cache import cached_njit
from .. import columns as c
from ..location import WALK, walk_history
from ..queue import ITEM_NODE, ITEM_SITE
from ..work_sharing import next_site
from .interleaved import (
    IDLE,
    SEARCH_NODE,
    SEARCH_PARENT,
    SEARCH_SITE,
    advance,
    idle_searches,
    start,
)
from .prefetch import prefetch_around, prefetch_beyond


class Lookahead(NamedTuple):
    """What each thread locates ahead.

    Attributes
    ----------
    searches : int64 (threads, most or a few more, 4)
        On their way; see `interleaved`.
    located : int64 (threads, most + 1 or a few more, 2)
        Sites and their leaves, and one of another thread that is helped.
    most : int
        Sites that a thread locates at a time.
    found : int
        What is kept of a search: its leaf, SEARCH_NODE, or the parent of that, SEARCH_PARENT.
    """

    searches: np.ndarray
    located: np.ndarray
    most: int
    found: int


def nothing_located(threads: int, most: int, *, parents: bool = False) -> Lookahead:
    """The beginning of a run in which each thread locates ``most`` sites at a time."""
    located = rows_apart(threads, 2 * (most + 1)).reshape(threads, -1, 2)
    return Lookahead(idle_searches(threads, most), located, most, SEARCH_PARENT if parents else SEARCH_NODE)


@cached_njit(forceinline=True)
def _next_start(mesh, me, schedule):
    """The next site of thread ``me``, which now is on its way; -1 where there is none left."""
    q = next_site(mesh, schedule, me)
    if q >= 0:
        mesh.state[me, c.NEXT] += 1
    return q


@cached_njit(forceinline=True)
def locate_ahead(mesh, me, schedule, lookahead, location):
    """Locate one more site of thread ``me``; whether one was left."""
    state = mesh.state
    if location == WALK:
        q = _next_start(mesh, me, schedule)
        if q < 0:
            return False
        t, visited = walk_history(mesh, state[me, c.HINT], q)
        state[me, c.HINT] = t
    else:
        searches = lookahead.searches[me]
        for i in range(lookahead.most):
            if searches[i, SEARCH_SITE] == IDLE:
                q = _next_start(mesh, me, schedule)
                if q < 0:
                    break
                start(mesh, searches, i, q)
        i, visited = advance(mesh, searches, lookahead.most)
        if i == IDLE:
            return False
        q, t = searches[i, SEARCH_SITE], searches[i, lookahead.found]
        searches[i, SEARCH_SITE] = IDLE
    state[me, c.VISITED] += visited
    end = state[me, c.LOCATED_END]
    lookahead.located[me, end, ITEM_SITE], lookahead.located[me, end, ITEM_NODE] = q, t
    state[me, c.LOCATED_END] = end + 1
    return True


@cached_njit(forceinline=True)
def next_located(mesh, me, lookahead):
    """The next located site of thread ``me``, of which there must be one, and the leaf it was located in.

    What the insertions after it will need begins to be loaded: first the surroundings of a site's leaf, then
    what lies beyond them.
    """
    state, located = mesh.state, lookahead.located[me]
    at, end = state[me, c.LOCATED_AT], state[me, c.LOCATED_END]
    if at + 2 < end:
        prefetch_around(mesh, located[at + 2, ITEM_NODE])
    if at + 1 < end:
        prefetch_beyond(mesh, located[at + 1, ITEM_NODE])
        state[me, c.LOCATED_AT] = at + 1
    else:
        state[me, c.LOCATED_AT] = state[me, c.LOCATED_END] = 0
    return located[at, ITEM_SITE], located[at, ITEM_NODE]

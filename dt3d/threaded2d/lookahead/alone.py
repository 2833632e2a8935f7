"""The sequential method with interleaved searches: what one thread gains from not waiting for memory.

Several sites are located at a time and then inserted one after the other, as by a thread of the circum-circle
method that is alone, without a pool. So the gain of interleaving is told apart from that of threads.
"""

from __future__ import annotations

from typing import NamedTuple

from ..._numba.kernel_cache import cached_njit
from .. import columns as c
from ..configuration import Options
from ..flips import insert
from ..location import DAG, find_again
from ..mesh import Store
from ..steps import CHANGED, FINISHED, LOCATED, method
from ..work_sharing import Schedule
from .located import Lookahead, locate_ahead, next_located, nothing_located


class Tools(NamedTuple):
    """What the method needs beside the mesh."""

    schedule: Schedule
    lookahead: Lookahead


def tools(store: Store, schedule: Schedule, options: Options) -> Tools:
    """For a run with these options."""
    return Tools(schedule, nothing_located(1, options.searches))


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """Locate one more site, as long as there is room, or insert the first of those located."""
    state = mesh.state
    if state[me, c.LOCATED_END] < tools.lookahead.most and locate_ahead(
        mesh, me, tools.schedule, tools.lookahead, DAG
    ):
        return LOCATED
    if state[me, c.LOCATED_AT] == state[me, c.LOCATED_END]:
        return FINISHED
    q, t = next_located(mesh, me, tools.lookahead)
    t, visited = find_again(mesh, t, q, DAG)
    state[me, c.HINT] = insert(mesh, me, t, q, 0)
    state[me, c.VISITED] += visited
    state[me, c.INSERTED] += 1
    return CHANGED


METHOD = method(tools, step)

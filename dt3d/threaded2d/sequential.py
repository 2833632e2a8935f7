"""The sequential method: locate, subdivide, legalise, one site after the other."""

from __future__ import annotations

from typing import NamedTuple

from .._numba.kernel_cache import cached_njit
from . import columns as c
from .configuration import Options
from .flips import insert
from .location import DAG, WALK, find
from .mesh import Store
from .steps import CHANGED, FINISHED, LOCATED, method
from .work_sharing import Schedule, next_site


class Tools(NamedTuple):
    """What the method needs beside the mesh."""

    schedule: Schedule
    location: int


def tools(store: Store, schedule: Schedule, options: Options) -> Tools:
    """For a run with these options."""
    return Tools(schedule, WALK if options.location == "walk" else DAG)


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """Locate the next site, or insert it."""
    state = mesh.state
    if state[me, c.PHASE] == c.BEGIN:
        q = next_site(mesh, tools.schedule, me)
        if q < 0:
            return FINISHED
        t, visited = find(mesh, me, q, tools.location)
        state[me, c.SITE], state[me, c.NODE], state[me, c.PHASE] = q, t, c.CHANGE
        state[me, c.VISITED] += visited
        return LOCATED
    state[me, c.HINT] = insert(mesh, me, state[me, c.NODE], state[me, c.SITE], 0)
    state[me, c.INSERTED] += 1
    state[me, c.NEXT] += 1
    state[me, c.PHASE] = c.BEGIN
    return CHANGED


METHOD = method(tools, step)

"""The pessimistic method: location in all threads, changes in one critical section (section 4.6).

I. Kolingerova, J. Kohout: Pessimistic threaded Delaunay triangulation by randomized incremental insertion,
GraphiCon 2000.
"""

from __future__ import annotations

from .._numba.atomics import compare_and_swap, give_way, release
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .flips import insert
from .location import find, find_again
from .patience import GIVING_WAY
from .sequential import tools
from .steps import CHANGED, FINISHED, LOCATED, WAITING, method
from .work_sharing import next_site

__all__ = ["METHOD", "step", "tools"]


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """Locate the next site, or try to enter the critical section and insert it."""
    state, shared = mesh.state, mesh.shared
    if state[me, c.PHASE] == c.BEGIN:
        q = next_site(mesh, tools.schedule, me)
        if q < 0:
            return FINISHED
        t, visited = find(mesh, me, q, tools.location)
        state[me, c.SITE], state[me, c.NODE], state[me, c.PHASE] = q, t, c.SUBDIVIDE
        state[me, c.VISITED] += visited
        return LOCATED
    if not compare_and_swap(shared, (c.CRITICAL, 0), 0, me + 1):
        return WAITING
    # what was a leaf before may have children now
    q = state[me, c.SITE]
    t, visited = find_again(mesh, state[me, c.NODE], q, tools.location)
    state[me, c.HINT] = insert(mesh, me, t, q, 0)
    release(shared, (c.CRITICAL, 0))
    state[me, c.VISITED] += visited
    state[me, c.INSERTED] += 1
    state[me, c.NEXT] += 1
    state[me, c.PHASE] = c.BEGIN
    return CHANGED


@cached_njit(forceinline=True)
def _wait(mesh, me, waited):
    mesh.state[me, c.WAITS] += waited == 0
    give_way()
    return GIVING_WAY


METHOD = method(tools, step, wait=_wait)

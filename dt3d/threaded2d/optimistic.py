"""The optimistic method: exclusive access triangle by triangle (section 4.6).

I. Kolingerova, J. Kohout: Optimistic parallel Delaunay triangulation, The Visual Computer 18, 2002.

Before a thread changes anything it has locked all triangles in conflict with its site and those around them;
if it does not get one, it gives all of them back and locates again from where it was. So every insertion
begins and ends with a Delaunay triangulation, no swap is given up, and no thread waits for another while it
holds a lock.
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import TURNS, store_release, wait_a_little
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .columns import triangle
from .dag import descend, locate
from .flips import insert
from .in_place.cavity import BUSY, lock_cavity, unlock
from .in_place.star import Tools, tools
from .patience import GIVING_WAY, NAP
from .steps import CHANGED, FINISHED, LOCATED, LOCKED, WAITING, method
from .work_sharing import next_site

__all__ = ["METHOD", "Tools", "step", "tools"]


@cached_njit(forceinline=True)
def unlock_star(nodes, f):
    """Unlock the star triangles about the first vertex of f, which this thread made locked."""
    last = nodes[f, 1]
    for _ in range(len(nodes)):  # more than any star has
        following = triangle(nodes[f, c.NEIGHBOR + 1])
        ends = nodes[f, 2] == last
        store_release(nodes, (f, c.LOCK), 0)
        if ends:
            return
        f = following
    msg = "a star of a 2D triangulation does not close"
    raise InternalError(msg)


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """One step of thread ``me``: locate a site, get exclusive access, or subdivide and legalise."""
    state = mesh.state
    if state[me, c.PHASE] == c.BEGIN:
        q = next_site(mesh, tools.schedule, me)
        if q < 0:
            return FINISHED
        t, visited = locate(mesh, q)
        state[me, c.SITE], state[me, c.NODE], state[me, c.PHASE] = q, t, c.LOCK_CAVITY
        state[me, c.VISITED] += visited
        return LOCATED
    q = state[me, c.SITE]
    if state[me, c.PHASE] == c.LOCK_CAVITY:
        t, visited = descend(mesh, state[me, c.NODE], q)
        state[me, c.NODE] = t
        state[me, c.VISITED] += visited
        state[me, c.ACCESSES] += 1
        size, _, count = lock_cavity(mesh, me, t, q, me + 1, tools.scratch)
        if size == BUSY:
            unlock(mesh.nodes, tools.scratch.locked[me], count)
            state[me, c.RETRIES] += 1
            return WAITING
        state[me, c.LOCKED], state[me, c.PHASE] = count, c.CHANGE
        return LOCKED
    f = insert(mesh, me, state[me, c.NODE], q, me + 1)
    unlock_star(mesh.nodes, f)
    unlock(mesh.nodes, tools.scratch.locked[me], state[me, c.LOCKED])
    state[me, c.HINT] = f
    state[me, c.INSERTED] += 1
    state[me, c.NEXT] += 1
    state[me, c.PHASE] = c.BEGIN
    return CHANGED


@cached_njit(forceinline=True)
def _wait(mesh, me, waited):
    """Give way for some turns, then sleep in each; these are counted as retries."""
    wait_a_little(waited)
    return GIVING_WAY if waited < TURNS else NAP


METHOD = method(tools, step, wait=_wait)

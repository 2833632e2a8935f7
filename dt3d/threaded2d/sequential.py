"""The sequential method: locate, subdivide, legalise, one site after the other."""

from __future__ import annotations

from .._numba.atomics import cycles
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .flips import insert
from .mesh import CHANGE_CYCLES, HINT, INSERTED, LOCATION_CYCLES, NEXT, VISITED
from .steps import DONE, GO_ON, find, spend, verdict
from .work_sharing import next_site, unowned_sites


@cached_njit(nogil=True)
def run(points, nodes, shared, state, sites, me, walking, w):
    """Insert sites until none is left for this thread; `DONE`, or why it came back before."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, w = unowned_sites(sites), unowned(w)
    begun = cycles()
    while True:
        reason = verdict(shared, True, True)
        if reason != GO_ON:
            return reason
        q = next_site(state, sites, me)
        if q < 0:
            return DONE
        t, visited = find(points, nodes, state, me, q, walking, w)
        begun = spend(state, me, LOCATION_CYCLES, begun)
        state[me, HINT] = insert(points, nodes, shared, state, me, t, q, 0, w)
        begun = spend(state, me, CHANGE_CYCLES, begun)
        state[me, VISITED] += visited
        state[me, INSERTED] += 1
        state[me, NEXT] += 1

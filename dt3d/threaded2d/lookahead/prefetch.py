"""Loading what insertions will need: the surroundings of triangles."""

from __future__ import annotations

from ..._numba.kernel_cache import cached_njit
from ..._numba.prefetch import prefetch
from .. import columns as c
from ..columns import side, triangle


@cached_njit(forceinline=True)
def prefetch_around(mesh, t):
    """Load the vertices of t, which is in the cache, and its neighbours."""
    for k in range(3):
        prefetch(mesh.nodes, triangle(mesh.nodes[t, c.NEIGHBOR + k]))
        prefetch(mesh.points, mesh.nodes[t, k])


@cached_njit(forceinline=True)
def prefetch_beyond(mesh, t):
    """Load the far vertices of the neighbours of t, which are in the cache, and the neighbours beyond."""
    nodes = mesh.nodes
    for k in range(3):
        edge = nodes[t, c.NEIGHBOR + k]
        u, j = triangle(edge), side(edge)
        prefetch(mesh.points, nodes[u, j])
        prefetch(nodes, triangle(nodes[u, c.NEIGHBOR + (j + 1) % 3]))
        prefetch(nodes, triangle(nodes[u, c.NEIGHBOR + (j + 2) % 3]))

"""From the memory of a growing triangulation to arrays without gaps."""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .mesh import is_finite, neighbor, tetrahedron, vertex


@cached_njit(nogil=True)
def count_finite(mesh, begin, end):
    """How many of the slots begin .. end-1 hold tetrahedra that are not ghosts."""
    mesh = unowned(mesh)
    m = 0
    for t in range(begin, end):
        m += is_finite(mesh, t)
    return m


@cached_njit(nogil=True)
def number_finite(mesh, begin, end, first, number):
    """Number them from ``first`` on; -1 for the others."""
    mesh = unowned(mesh)
    for t in range(begin, end):
        if is_finite(mesh, t):
            number[t] = first
            first += 1
        else:
            number[t] = -1


@cached_njit(nogil=True)
def write_finite(mesh, begin, end, number, original, simplices, neighbors):
    """Rows of the result: vertices by their indices in the input, neighbours by number, -1 beyond the
    hull."""
    mesh = unowned(mesh)
    for t in range(begin, end):
        s = number[t]
        if s >= 0:
            for k in range(4):
                simplices[s, k] = original[vertex(mesh, t, k)]
                neighbors[s, k] = number[tetrahedron(neighbor(mesh, t, k))]

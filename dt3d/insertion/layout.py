"""How a growing triangulation lies in memory, and the numbers that have a meaning of their own.

Sites are rows of four float64, 32 bytes: the coordinates; a place that `star` numbers vertices in; and, from
1 on, a tetrahedron that has the site, 0 as long as none is known.

A tetrahedron t is two records of 32 bytes, each within one line of the cache:

* ``mesh[8 t : 8 t + 8]``, uint32: its vertices v0 .. v3, sites or `INFINITE`, then its neighbours: 4 u + j
  where the k-th facet of t (opposite its k-th vertex) is the j-th of u. A tetrahedron is positive; a
  ghost, which has the infinite vertex, would be if that were a site beyond its facet. `DEAD` in the place
  of v0 marks a free slot.
* ``spheres[4 t : 4 t + 3]``, float64: about the centre of its circumsphere; then two float32, its radius
  squared rounded down and up so far that a comparison with them is a proof (`spheres.py`). The sign of the
  second marks the tetrahedra of the cavity that is being searched.

Facets go by the four-group: k, k^1, k^2, k^3 is an even permutation of 0, 1, 2, 3 for every k, so the
vertices at k^1, k^2, k^3 of a positive tetrahedron are its k-th facet, in the order that the k-th vertex
sees.

All numbers are unsigned where they are array elements: compiled code then knows that no index is negative.
"""

from __future__ import annotations

import numpy as np

INFINITE = 0xFFFFFFFF
DEAD = 0xFFFFFFFE
MOST_SLOTS = 2**30  # facets are named by 32 bits

LINE = 64  # bytes


def aligned(n: int, dtype: type) -> np.ndarray:
    """An uninitialised array that begins at a line of the cache."""
    size = np.dtype(dtype).itemsize
    raw = np.empty(n * size + LINE, np.uint8)
    begin = -raw.ctypes.data % LINE
    return raw[begin : begin + n * size].view(dtype)

"""How a growing triangulation lies in memory: records, the words in them, and what reads and writes a word.

Nothing else in the package computes the index of a word. There are three arrays, in one bundle, `Mesh`; two
of them have views of another dtype.

* A site v is a row of 32 bytes: its coordinates, float64; a number that `star` gives it; and, from 1 on, a
  tetrahedron that has it, 0 as long as none is known.
* A tetrahedron t is two records of 32 bytes, each within one line of the cache. One has its vertices v0 ..
  v3, uint32, sites or `INFINITE`, and its neighbours: facet j of tetrahedron u as the number 4 u + j, where
  the k-th facet of t (opposite its k-th vertex) is the j-th of u. A tetrahedron is positive; a ghost, which
  has the infinite vertex, would be if that were a site beyond its facet. `FREE` in the place of v0 marks a
  free slot, and the place of the first neighbour then has the next free one.
* The other has the centre of its circumsphere, float64, and two float32: the radius squared, rounded down and
  up so far that a comparison with them is a proof (`spheres.py`). The sign of the second marks the
  tetrahedra of the cavity that is being searched.

Facets go by the four-group: k, k^1, k^2, k^3 is an even permutation of 0, 1, 2, 3 for every k, so the
vertices at k^1, k^2, k^3 of a positive tetrahedron are its k-th facet, in the order that the k-th vertex
sees.

All numbers are unsigned where they are array elements: compiled code then knows that no index is negative.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
import numpy.typing as npt

from .._numba.kernel_cache import cached_njit
from .._numba.prefetch import prefetch

INFINITE = 0xFFFFFFFF
FREE = 0xFFFFFFFE
MOST_SLOTS = 2**30  # facets are named by 32 bits

HINT = 1 << 31  # and a site near it, in the place of the tetrahedron of a site that is not inserted yet

CACHE_LINE = 64  # bytes

accessor = cached_njit(inline="always", error_model="numpy")


class Mesh(NamedTuple):
    """The arrays of a triangulation of n sites with room for m tetrahedra."""

    points: npt.NDArray[np.float64]  # (n, 3): the coordinates in ``sites``
    sites: npt.NDArray[np.float64]  # (4 n,)
    labels: npt.NDArray[np.uint32]  # (8 n,): ``sites`` again
    tetrahedra: npt.NDArray[np.uint32]  # (8 m,)
    spheres: npt.NDArray[np.float64]  # (4 m,)
    radii: npt.NDArray[np.float32]  # (8 m,): ``spheres`` again


class Site(NamedTuple):
    """A site at hand: its number and its coordinates."""

    v: int
    x: float
    y: float
    z: float


def bundle(
    sites: npt.NDArray[np.float64], tetrahedra: npt.NDArray[np.uint32], spheres: npt.NDArray[np.float64]
) -> Mesh:
    """The three arrays and their views."""
    points = sites.reshape(-1, 4)[:, :3]  # without the labels, which are no coordinates
    return Mesh(points, sites, sites.view(np.uint32), tetrahedra, spheres, spheres.view(np.float32))


MESH = numba.typeof(bundle(np.empty(8), np.empty(8, np.uint32), np.empty(4)))  # one site is too contiguous


def aligned(n: int, dtype: npt.DTypeLike) -> np.ndarray:
    """An uninitialised array that begins at a line of the cache."""
    size = np.dtype(dtype).itemsize
    raw = np.empty(n * size + CACHE_LINE, np.uint8)
    begin = -raw.ctypes.data % CACHE_LINE
    return raw[begin : begin + n * size].view(dtype)


def vertices(mesh: Mesh) -> npt.NDArray[np.uint32]:
    """A view of the vertices of all slots, (m, 4)."""
    return mesh.tetrahedra.reshape(-1, 8)[:, :4]


def neighbors(mesh: Mesh) -> npt.NDArray[np.uint32]:
    """A view of the neighbours of all slots, (m, 4), as facets."""
    return mesh.tetrahedra.reshape(-1, 8)[:, 4:]


def with_hints(sites: npt.NDArray[np.float64], near: npt.NDArray[np.int32]) -> npt.NDArray[np.float64]:
    """Rows for sites, float64 (k, 3), with a site near each that is inserted; -1 for none."""
    rows = np.zeros((len(sites), 4))
    rows[:, :3] = sites
    rows.view(np.uint32)[:, 7] = np.where(near >= 0, near.astype(np.int64) + HINT, 0)
    return rows.reshape(-1)


def inserted_rows(sites: npt.NDArray[np.float64], step: int) -> npt.NDArray[np.int64]:
    """Those of each ``step``-th row of sites, float64 (4 n,), that are known to be vertices."""
    words = sites.view(np.uint32)[7 :: 8 * step]
    return step * np.flatnonzero((words > 0) & (words < HINT))


def squared_radii(mesh: Mesh) -> npt.NDArray[np.float32]:
    """A view of the squared radii of all slots, (m, 2), rounded down and up."""
    return mesh.radii.reshape(-1, 8)[:, 6:]


@accessor
def facet(t, k):
    """The number of the k-th facet of tetrahedron t."""
    return 4 * t + k


@accessor
def tetrahedron(facet):
    """The tetrahedron that a facet is of."""
    return facet >> 2


@accessor
def side(facet):
    """Which of the four facets of its tetrahedron a facet is."""
    return facet & 3


@accessor
def vertex(mesh, t, k):
    """The k-th vertex of tetrahedron t."""
    return numba.int64(mesh.tetrahedra[8 * t + k])


@accessor
def neighbor(mesh, t, k):
    """The facet beyond the k-th facet of tetrahedron t."""
    return numba.int64(mesh.tetrahedra[8 * t + 4 + k])


@accessor
def set_vertex(mesh, t, k, v):
    """Make v the k-th vertex of tetrahedron t."""
    mesh.tetrahedra[8 * t + k] = v


@accessor
def set_neighbor(mesh, t, k, facet):
    """Note the facet beyond the k-th facet of tetrahedron t."""
    mesh.tetrahedra[8 * t + 4 + k] = facet


@accessor
def is_finite(mesh, t):
    """Whether slot t holds a tetrahedron that is no ghost."""
    return (
        max(max(vertex(mesh, t, 0), vertex(mesh, t, 1)), max(vertex(mesh, t, 2), vertex(mesh, t, 3))) < FREE
    )


@accessor
def free_slot(mesh, t, following):
    """Put slot t before another one on the list of free slots."""
    set_vertex(mesh, t, 0, FREE)
    set_neighbor(mesh, t, 0, following)


@accessor
def next_free(mesh, t):
    """The slot that follows t on the list of free slots."""
    return neighbor(mesh, t, 0)


@accessor
def prefetch_tetrahedron(mesh, t):
    """Begin to load the vertices and neighbours of t."""
    prefetch(mesh.tetrahedra, 8 * t)


@accessor
def prefetch_sphere(mesh, t):
    """Begin to load the sphere of t."""
    prefetch(mesh.radii, 8 * t)


@accessor
def set_center(mesh, t, x, y, z):
    """Store the centre of the sphere of t."""
    mesh.spheres[4 * t], mesh.spheres[4 * t + 1], mesh.spheres[4 * t + 2] = x, y, z


@accessor
def squared_distance(mesh, t, site):
    """The square of a site's distance from the centre of the sphere of t."""
    x = mesh.spheres[4 * t] - site.x
    y = mesh.spheres[4 * t + 1] - site.y
    z = mesh.spheres[4 * t + 2] - site.z
    return x * x + y * y + z * z


@accessor
def radius_below(mesh, t):
    """The squared radius of the sphere of t, rounded down."""
    return mesh.radii[8 * t + 6]


@accessor
def radius_above(mesh, t):
    """The squared radius of the sphere of t, rounded up; negative in the cavity."""
    return mesh.radii[8 * t + 7]


@accessor
def set_radius(mesh, t, below, above):
    """Store the squared radius of the sphere of t, rounded down and up; t is not in the cavity."""
    mesh.radii[8 * t + 6], mesh.radii[8 * t + 7] = below, above


@accessor
def mark(mesh, t):
    """Note that t is in the cavity."""
    mesh.radii[8 * t + 7] = -mesh.radii[8 * t + 7]


@accessor
def unmark(mesh, t):
    """Note that t is not in the cavity."""
    mesh.radii[8 * t + 7] = abs(mesh.radii[8 * t + 7])


@accessor
def site_at_hand(mesh, v):
    """Site v with its coordinates."""
    return Site(v, mesh.sites[4 * v], mesh.sites[4 * v + 1], mesh.sites[4 * v + 2])


@accessor
def offset(mesh, v, site):
    """Site v minus another site, rounded."""
    return mesh.sites[4 * v] - site.x, mesh.sites[4 * v + 1] - site.y, mesh.sites[4 * v + 2] - site.z


@accessor
def label(mesh, v):
    """The number of site v in the last star that had it; anything before the first."""
    return numba.int64(mesh.labels[8 * v + 6])


@accessor
def set_label(mesh, v, number):
    """Give site v a number in a star."""
    mesh.labels[8 * v + 6] = number


@accessor
def tetrahedron_of(mesh, v):
    """A tetrahedron that has site v, -1 as long as none is known."""
    return numba.int64(mesh.labels[8 * v + 7]) - 1


@accessor
def start_for(mesh, v, last):
    """Where the walk to site v begins: at a tetrahedron of the site that its hint names, else at ``last``."""
    start = last
    word = numba.int64(mesh.labels[8 * v + 7])
    if word >= HINT:
        start = tetrahedron_of(mesh, word - HINT)
    return start


@accessor
def set_tetrahedron_of(mesh, v, t):
    """Note that site v is a vertex of tetrahedron t."""
    mesh.labels[8 * v + 7] = t + 1

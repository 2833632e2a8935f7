"""Voronoi cells within a box, compiled: the box, cut by the bisectors between a site and its neighbours.

C. H. Rycroft: Voro++: A three-dimensional Voronoi cell library in C++. Chaos 19, 2009. The neighbours of a
site are known from the ridges, so there is no search, and the cell is right wherever the box is.

Rounding stays small beside each cell: its coordinates are relative to its site, or to the point of the box
that is next to it. A bisector is computed in pairs of doubles, so that two sites see it at the same place.
What is cut first is not the whole box, but what of it lies within twice the distance of the cell's vertices.

In the plane cells are prisms of height 1.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from ..predicates import double_double as dd
from .polytope import (
    FACES,
    LABEL,
    ROOM,
    area_vector,
    cut,
    empty_polytope,
    has_room,
    make_box,
    volume,
)

WALLS = (-1, -2, -3, -4, -5, -6)  # labels: low and high for each axis in turn
BEYOND = -7  # of walls between which a cell has to lie, and that it does not touch


class Sites(NamedTuple):
    """Sites, scaled, and the ridges of each.

    Attributes
    ----------
    dimension : int
        2 in the plane, 3 in space.
    points : float64 (n, 3)
        The third coordinate is 0 in the plane.
    reach : float64 (n,)
        The distance of the farthest vertex of each cell, infinite if the cell is.
    box : float64 (2, 3)
        Its low and high corner; in the plane the third coordinates are 0 and 1.
    begin, around : int64 (n + 1,) and int64 (2 r,)
        The ridges of site k are around[begin[k]:begin[k + 1]].
    ends : int32 (r, 2)
        The sites of each ridge.
    """

    dimension: int
    points: npt.NDArray[np.float64]
    reach: npt.NDArray[np.float64]
    box: npt.NDArray[np.float64]
    begin: npt.NDArray[np.int64]
    around: npt.NDArray[np.int64]
    ends: npt.NDArray[np.int32]


@cached_njit
def ridges_of_sites(ends, n):
    """The ridges of each of n sites: where those of site k begin, int64 (n + 1,), and all, int64 (2 r,)."""
    begin = np.zeros(n + 1, np.int64)
    for i in range(len(ends)):
        begin[ends[i, 0] + 1] += 1
        begin[ends[i, 1] + 1] += 1
    for k in range(n):
        begin[k + 1] += begin[k]
    at, around = begin[:-1].copy(), np.empty(2 * len(ends), np.int64)
    for i in range(len(ends)):
        for side in range(2):
            k = ends[i, side]
            around[at[k]] = i
            at[k] += 1
    return begin, around


@cached_njit
def _difference(x, y):
    """The vector from y to x, as three pairs; exact."""
    return dd.two_sum(x[0], -y[0]), dd.two_sum(x[1], -y[1]), dd.two_sum(x[2], -y[2])


@cached_njit
def _bisector(p, q, origin):
    """The plane a x + b y + c z <= d of what is nearer to p than to q, (a, b, c, d), from an origin.

    n (x - m) <= 0 with n = q - p and m their midpoint, n of length about 1.
    """
    normal = _difference(q, p)
    middle = _difference(p, origin), _difference(q, origin)
    d = dd.multiply(normal[0], dd.add(middle[0][0], middle[1][0]))
    d = dd.add(d, dd.multiply(normal[1], dd.add(middle[0][1], middle[1][1])))
    d = dd.add(d, dd.multiply(normal[2], dd.add(middle[0][2], middle[1][2])))
    a, b, c = normal[0][0], normal[1][0], normal[2][0]
    exponent = math.frexp(max(abs(a), abs(b), abs(c)))[1]
    return (
        math.ldexp(a, -exponent), math.ldexp(b, -exponent), math.ldexp(c, -exponent),
        math.ldexp(d[0], -exponent - 1),
    )  # fmt: skip


@cached_njit
def _first_box(sites, k, origin, reach, cell):
    """Make the cell the part of the box within a distance of the site, relative to an origin."""
    low, high, labels = np.empty(3), np.empty(3), np.empty(6, np.int64)
    for axis in range(3):
        low[axis], high[axis] = sites.box[0, axis] - origin[axis], sites.box[1, axis] - origin[axis]
        labels[2 * axis], labels[2 * axis + 1] = WALLS[2 * axis], WALLS[2 * axis + 1]
        if axis == sites.dimension:
            break  # prisms stay as high as they are
        middle = sites.points[k, axis] - origin[axis]
        if middle - reach > low[axis]:
            low[axis], labels[2 * axis] = middle - reach, BEYOND
        if middle + reach < high[axis]:
            high[axis], labels[2 * axis + 1] = middle + reach, BEYOND
        if low[axis] > high[axis]:
            low[axis] = high[axis]
    make_box(cell, low, high, labels)


@cached_njit
def _cut_cell(sites, k, reach, cell, spare):
    """Cut the cell of site k out of the box, or of the part of it within a distance.

    Returns 0 if the first polytope is the cell, 1 if the second one is, and -1 if they have not enough room.
    Labels of faces are `WALLS`, `BEYOND`, or the numbers of ridges.
    """
    p, origin, swapped = sites.points[k], np.empty(3), 0
    for axis in range(3):
        origin[axis] = min(max(p[axis], sites.box[0, axis]), sites.box[1, axis])
    _first_box(sites, k, origin, reach, cell)
    if sites.begin[k] == sites.begin[k + 1]:
        cell.size[:] = 0  # a duplicate has no cell
    for i in range(sites.begin[k], sites.begin[k + 1]):
        ridge = sites.around[i]
        q = sites.ends[ridge, 0] if sites.ends[ridge, 0] != k else sites.ends[ridge, 1]
        if not has_room(cell):
            return -1
        if cut(cell, _bisector(p, sites.points[q], origin), ridge, spare):
            cell, spare, swapped = spare, cell, 1 - swapped
    return swapped


@cached_njit
def _clip_cell(sites, k, one, other):
    """The cell of site k in the box, relative to the point of the box that is next to the site.

    It is cut out of what of the box is within a distance that holds it, or all where that proves wrong.
    Returns which polytope it is, as `_cut_cell`.
    """
    one, other = unowned(one), unowned(other)
    reach = 2.0 * sites.reach[k]
    while True:
        which = _cut_cell(sites, k, reach, one, other)
        cell, beyond = one if which == 0 else other, False
        for face in range(cell.size[FACES]):
            beyond = beyond or cell.faces[face, LABEL] <= BEYOND
        if which < 0 or not beyond:
            return which
        reach = math.inf


@cached_njit
def _smaller(sites, ridge):
    """The site of a ridge whose cell is smaller."""
    p, q = sites.ends[ridge, 0], sites.ends[ridge, 1]
    return q if sites.reach[q] < sites.reach[p] else p


@cached_njit(nogil=True)
def measure_cells(sites, part, volumes, areas):
    """Write the volumes of some cells, and the areas of their ridges if there is room for them.

    That of a ridge comes from the site with the smaller cell: from afar, bisectors with sites that lie close
    together are nearly the same, and rounding moves where they meet.

    Returns
    -------
    Polytope
        The last cell, relative to the point of the box that is next to its site.
    """
    sites, volumes, areas = unowned(sites), unowned(volumes), unowned(areas)
    room, which = ROOM, 0
    one, other = empty_polytope(room), empty_polytope(room)
    for k in range(part[0], part[1]):
        which = _clip_cell(sites, k, one, other)
        while which < 0:
            room *= 4
            one, other = empty_polytope(room), empty_polytope(room)
            which = _clip_cell(sites, k, one, other)
        cell = unowned(one if which == 0 else other)
        volumes[k - part[0]] = volume(cell)
        for face in range(cell.size[FACES]):
            ridge = cell.faces[face, LABEL]
            if 0 <= ridge < len(areas) and _smaller(sites, ridge) == k:
                x, y, z = area_vector(cell, face)
                areas[ridge] += math.hypot(math.hypot(x, y), z)
    return one if which == 0 else other

"""Sibson's weights: how much of each cell a point would take if it were a site.

R. Sibson: A vector identity for the Dirichlet tessellation, Mathematical Proceedings of the Cambridge
Philosophical Society 87, 1980. Inserting the point would remove the simplices in whose spheres it lies, its
cavity, and join it with the cavity's boundary. The size of a cell is a sum over the facets at its site v,
with the centers p and q of the simplices on both sides: in space a third of |q - p| times the part of the
triangle that is nearer to v than to its other corners, signed; in the plane a quarter of |q - p| times the
edge. So what a cell loses is that sum over the facets of the cavity's simplices less that over the new
facets; at the boundary of the cavity p is the center on the inner side and q the new one. No center of a flat
simplex occurs, as it does in D. Watson's formula (Contouring, 1992), and centers far away do no harm.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._star import side_of_facet
from .._topology import OUTSIDE
from ..geometry.barycentric import plain_weights, weights_of_pairs
from ..predicates import plane, space
from .taken import cells_in_plane, cells_in_space, new_centers

WORST_SUM = 1e-10  # of a neighbour's distance: what the weighted sum of neighbours may be off

MOST_STAMPS = 2**30  # of int32, then they begin again; one call takes fewer than 2^20

FULL, FLAT = -1, -2  # no room for a cavity, and a new simplex that is flat


class Scratch(NamedTuple):
    """The memory of one thread."""

    offsets: np.ndarray  # float64 (m, d), of all threads: the center of each simplex, from its first vertex
    seen: np.ndarray  # int32 (m,): the last stamp of a point whose cavity has the simplex, negative: has not
    place: np.ndarray  # int32 (n,): the number of a site among the natural neighbours at hand, or -1
    stamp: np.ndarray  # int32 (1,)
    cavity: np.ndarray  # int32 (c,)
    facets: np.ndarray  # int32 (c, 2)
    edges: np.ndarray  # int32 (3 c, 3): in space, edges of new simplices that wait for the other side
    sides: np.ndarray  # int32 (c, 2): in the plane, the new triangles on both sides of an edge to the point
    centers: np.ndarray  # float64 (c, d), of new simplices, from the point
    ring: np.ndarray  # int32 (c,): natural neighbours
    taken: np.ndarray  # float64 (c,): of their cells
    growth: np.ndarray  # float64 (c, d): by which that grows as the point moves
    work: np.ndarray  # float64: of the exact predicates


class Weights(NamedTuple):
    """What is written of the points of one thread; rows of a sparse matrix."""

    counts: np.ndarray  # int32 (k,)
    indices: np.ndarray  # int32 (room,)
    weights: np.ndarray  # float64 (room,)
    slopes: np.ndarray  # float64 (room, d), or (1, d) where they are not wanted


@cached_njit(error_model="numpy")
def _conflict(cells, t, q, w):
    """Whether row q lies in the perturbed sphere of simplex t."""
    row = cells.simplices[t]
    if cells.simplices.shape[1] == 3:
        return plane.inside(cells.rows, (row[0], row[1], row[2]), q, w)
    return space.inside(cells.rows, (row[0], row[1], row[2], row[3]), q, w)


@cached_njit(error_model="numpy")
def _cavity(cells, t, q, w, seen, stamp, cavity, facets):
    """Write the simplices in conflict with row q, and their facets on the boundary, (simplex, k).

    Returns how many there are of both; `FULL` if there is no room. If q lies on the hull, `FLAT`, and whether
    several facets of the hull around it lie on one plane.
    """
    corners = cells.simplices.shape[1]
    cavity[0], count, done, open_facets = t, 1, 0, 0
    flat, first, one_plane = OUTSIDE, 0, 0
    seen[t] = stamp
    while done < count:
        t = cavity[done]
        done += 1
        for k in range(corners):
            u = cells.neighbors[t, k]
            if u != OUTSIDE and seen[u] == stamp:
                continue
            if u != OUTSIDE and seen[u] != -stamp:
                if _conflict(cells, u, q, w):
                    seen[u] = stamp
                    if count == len(cavity):
                        return FULL, FULL
                    cavity[count] = u
                    count += 1
                    continue
                seen[u] = -stamp
            if u == OUTSIDE and side_of_facet(cells, t, k, q, w) == 0:
                if flat == OUTSIDE:
                    flat, first = t, k
                else:
                    beside = True
                    for i in range(corners):
                        v = cells.simplices[t, i]
                        beside = beside and (i == k or side_of_facet(cells, flat, first, v, w) == 0)
                    one_plane = max(one_plane, beside)
            if open_facets == len(facets):
                return FULL, FULL
            facets[open_facets, 0], facets[open_facets, 1] = t, k
            open_facets += 1
    if flat != OUTSIDE:
        return FLAT, one_plane
    return count, open_facets


@cached_njit(error_model="numpy")
def _at_site(cells, t, x):
    """The vertex of simplex t that is x, or -1."""
    for k in range(cells.simplices.shape[1]):
        v, same = cells.simplices[t, k], True
        for i in range(len(x)):
            same = same and cells.rows[v, i] == x[i]
        if same:
            return v
    return -1


@cached_njit(error_model="numpy")
def _move_inwards(cells, t, x, part, y):
    """Write the point that is this part of the way from x to the middle of simplex t."""
    corners = cells.simplices.shape[1]
    for i in range(len(x)):
        middle = 0.0
        for k in range(corners):
            middle += cells.rows[cells.simplices[t, k], i] / corners
        y[i] = x[i] + part * (middle - x[i])


@cached_njit(nogil=True, error_model="numpy")
def natural_neighbors(cells, q, points, found, begin, end, scratch, out):
    """Write neighbours and weights of points begin .. end-1, in simplices found, one after the other.

    For a point in no simplex there is nothing. On the hull what is taken has no bounds, and weights are
    limits from inside: the barycentric ones where no sites but the facet's are on its plane, and always in
    the plane itself; else those of the point moved inwards by a part of 2^-36 of the way to the middle of its
    simplex.

    The weights have to give the point itself as the sum of its neighbours. Where they do not, as rounding has
    spoilt sizes (cells a billion times as long as wide), the barycentric ones take their place; they are
    infinite in a simplex that is so flat that pairs of doubles do not tell.

    Returns
    -------
    int64, int64
        The point that has no room for its neighbours, or ``end``, and how many entries were written.
    """
    cells, w = unowned(cells), unowned(scratch.work)
    written, d = 0, points.shape[1]
    if scratch.stamp[0] > MOST_STAMPS:
        scratch.seen[:] = scratch.stamp[0] = 0
    stamp = scratch.stamp[0]
    y = cells.rows[q]
    for i in range(begin, end):
        out.counts[i] = 0
        t = found[i]
        if t < 0:
            continue
        if written + len(scratch.ring) > len(out.indices):
            scratch.stamp[0] = stamp
            return i, written
        x = points[i]
        site = _at_site(cells, t, x)
        if site >= 0:
            out.counts[i], out.indices[written], out.weights[written] = 1, site, 1.0
            out.slopes[written if len(out.slopes) > 1 else 0] = np.nan
            written += 1
            continue
        y[:] = x
        number = -1
        for attempt in range(6):
            if attempt > 0:
                _move_inwards(cells, t, x, 2.0 ** (5 * attempt - 41), y)
            stamp += 1
            sizes = _cavity(cells, t, q, w, scratch.seen, stamp, scratch.cavity, scratch.facets)
            if sizes[0] == FULL:
                scratch.stamp[0] = stamp
                return -1 - i, written
            if sizes[0] == FLAT and (d == 2 or sizes[1] == 0):
                break
            if sizes[0] == FLAT or not new_centers(cells, y, sizes[1], scratch):
                continue
            if d == 2:
                number = cells_in_plane(cells, y, stamp, sizes, scratch)
            else:
                number = cells_in_space(cells, y, stamp, sizes, scratch)
            break
        for k in range(number):
            scratch.place[scratch.ring[k]] = -1
        if number < 0 or not _write(cells, x, number, written, scratch, out):
            number = d + 1
            _write_barycentric(cells, t, x, written, out)
        out.counts[i] = number
        written += number
    scratch.stamp[0] = stamp
    return end, written


@cached_njit(error_model="numpy")
def _write_barycentric(cells, t, x, written, out):
    """Write the weights of the vertices of simplex t, infinite if pairs leave them open; NaN as slopes."""
    corners = cells.simplices.shape[1]
    row, weights = cells.simplices[t], out.weights[written : written + corners]
    if not plain_weights(cells.rows, row, x, weights) and not weights_of_pairs(cells.rows, row, x, weights):
        weights[:] = np.inf  # the simplex is flat but for 2^-45 of its size
    out.indices[written : written + corners] = row
    for k in range(corners):
        weights[k] = max(weights[k], 0.0)
        if len(out.slopes) > 1:
            out.slopes[written + k] = np.nan


@cached_njit(error_model="numpy")
def _write(cells, x, number, written, scratch, out):
    """Write the weights of one point, whose sum is 1, and the derivatives of these, whose sum is 0.

    Returns whether the weights give the point as the sum of its neighbours.
    """
    total, d = 0.0, len(x)
    for k in range(number):
        scratch.taken[k] = max(scratch.taken[k], 0.0)  # rounding may have taken less than nothing
        total += scratch.taken[k]
    if not 0.0 < total < np.inf:
        return False
    for k in range(number):
        out.indices[written + k] = scratch.ring[k]
        out.weights[written + k] = scratch.taken[k] / total
    for i in range(d):
        off, size = 0.0, 0.0
        for k in range(number):
            side = cells.rows[scratch.ring[k], i] - x[i]
            off += out.weights[written + k] * side
            size = max(size, abs(side))
        if not abs(off) <= WORST_SUM * size:
            return False
    if len(out.slopes) > 1:
        for i in range(d):
            growth = 0.0
            for k in range(number):
                growth += scratch.growth[k, i]
            for k in range(number):
                slope = scratch.growth[k, i] - out.weights[written + k] * growth
                out.slopes[written + k, i] = slope / total
    return True

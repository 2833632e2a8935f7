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

import math
from typing import NamedTuple

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._star import side_of_facet
from .._topology import OUTSIDE, OUTWARD
from ..geometry.barycentric import plain_weights, weights_of_pairs
from ..geometry.pairs import RELIABLE, cross, dot, extent, shrinking, sides_in_plane, sides_in_space
from ..predicates import double_double as dd
from ..predicates import plane, space

WELL_SHAPED = 2.0**-16  # as in `dt3d.geometry.barycentric`

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
def _center_in_plane(rows, a, b, x, out):
    """Write the center of the circle through rows a, b and point x, from x; whether that is reliable."""
    px, py, qx, qy = rows[a, 0] - x[0], rows[a, 1] - x[1], rows[b, 0] - x[0], rows[b, 1] - x[1]
    det = px * qy - py * qx
    pp, qq = px * px + py * py, qx * qx + qy * qy
    if abs(det) > WELL_SHAPED * (max(abs(px), abs(qx)) * max(abs(py), abs(qy))) and det * det > 1e-250:
        out[0], out[1] = (pp * qy - qq * py) / (2.0 * det), (qq * px - pp * qx) / (2.0 * det)
        return True
    shrink = shrinking(rows, (a, b), x)
    p, q = sides_in_plane(rows[a], x, shrink), sides_in_plane(rows[b], x, shrink)
    pair = dd.minor(p, q)[0]
    if not abs(pair) > RELIABLE * (extent((p, q), 0) * extent((p, q), 1)):
        return False
    r, s = dd.square(p), dd.square(q)
    out[0] = dd.subtract(dd.multiply(r, q[1]), dd.multiply(s, p[1]))[0] / pair / 2.0 / shrink
    out[1] = dd.subtract(dd.multiply(s, p[0]), dd.multiply(r, q[0]))[0] / pair / 2.0 / shrink
    return True


@cached_njit(error_model="numpy")
def _center_in_space(rows, a, b, c, x, out):
    """Write the center of the sphere through rows a, b, c and point x, from x; whether that is reliable."""
    ux, uy, uz = rows[a, 0] - x[0], rows[a, 1] - x[1], rows[a, 2] - x[2]
    vx, vy, vz = rows[b, 0] - x[0], rows[b, 1] - x[1], rows[b, 2] - x[2]
    wx, wy, wz = rows[c, 0] - x[0], rows[c, 1] - x[1], rows[c, 2] - x[2]
    vwx, vwy, vwz = vy * wz - vz * wy, vz * wx - vx * wz, vx * wy - vy * wx
    det = ux * vwx + uy * vwy + uz * vwz
    product = max(abs(ux), abs(vx), abs(wx)) * max(abs(uy), abs(vy), abs(wy)) * max(abs(uz), abs(vz), abs(wz))
    if abs(det) > WELL_SHAPED * product and det * det > 1e-250:
        wux, wuy, wuz = wy * uz - wz * uy, wz * ux - wx * uz, wx * uy - wy * ux
        uvx, uvy, uvz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        uu, vv, ww = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz
        out[0] = (uu * vwx + vv * wux + ww * uvx) / (2.0 * det)
        out[1] = (uu * vwy + vv * wuy + ww * uvy) / (2.0 * det)
        out[2] = (uu * vwz + vv * wuz + ww * uvz) / (2.0 * det)
        return True
    shrink = shrinking(rows, (a, b, c), x)
    u, v = sides_in_space(rows[a], x, shrink), sides_in_space(rows[b], x, shrink)
    w = sides_in_space(rows[c], x, shrink)
    vw, wu, uv = cross(v, w), cross(w, u), cross(u, v)
    pair = dot(u, vw)[0]
    if not abs(pair) > RELIABLE * (extent((u, v, w), 0) * extent((u, v, w), 1) * extent((u, v, w), 2)):
        return False
    r, s, t = dd.square(u), dd.square(v), dd.square(w)
    for i in range(3):
        total = dd.add(dd.add(dd.multiply(r, vw[i]), dd.multiply(s, wu[i])), dd.multiply(t, uv[i]))
        out[i] = total[0] / pair / 2.0 / shrink
    return True


@cached_njit(error_model="numpy")
def _local(v, place, ring, count):
    """The number of row v among the ``count`` natural neighbours so far, and how many these are now."""
    if place[v] < 0:
        place[v] = count
        ring[count] = v
        count += 1
    return place[v], count


@cached_njit(error_model="numpy")
def _from(rows, v, x):
    """Row v less x, in the plane."""
    return rows[v, 0] - x[0], rows[v, 1] - x[1]


@cached_njit(error_model="numpy")
def _quarter(a, b, p, q):
    """What the edge from a to b gives the cells of both, with the centers p on its left and q on its right.

    The two triangles of a, or b, and the piece of the cells' border from p to q: |b - a| |q - p| / 4, signed.
    """
    return ((b[1] - a[1]) * (q[0] - p[0]) - (b[0] - a[0]) * (q[1] - p[1])) / 4.0


@cached_njit(error_model="numpy")
def _cells_in_plane(cells, y, stamp, sizes, scratch):
    """Write what y takes of the cells around, and how that grows as it moves; returns how many cells."""
    count, open_facets = sizes
    rows, simplices = cells.rows, cells.simplices
    number = 0
    for i in range(open_facets):
        t, k = scratch.facets[i]
        for j in (1, 2):
            _, number = _local(simplices[t, (k + j) % 3], scratch.place, scratch.ring, number)
    taken, growth = scratch.taken, scratch.growth
    taken[:number] = 0.0
    growth[:number] = 0.0
    for i in range(count):
        t = scratch.cavity[i]
        p = _old_center(cells, scratch.offsets, t, y)
        for k in range(3):
            u = cells.neighbors[t, k]
            if u < t or scratch.seen[u] != stamp:  # the others from the other side, or below
                continue
            q = _old_center(cells, scratch.offsets, u, y)
            a, b = simplices[t, (k + 1) % 3], simplices[t, (k + 2) % 3]
            size = _quarter(_from(rows, a, y), _from(rows, b, y), p, q)
            taken[scratch.place[a]] += size
            taken[scratch.place[b]] += size
    for i in range(open_facets):
        t, k = scratch.facets[i]
        p = _old_center(cells, scratch.offsets, t, y)
        q = scratch.centers[i, 0], scratch.centers[i, 1]
        a, b = simplices[t, (k + 1) % 3], simplices[t, (k + 2) % 3]
        size = _quarter(_from(rows, a, y), _from(rows, b, y), p, q)
        taken[scratch.place[a]] += size
        taken[scratch.place[b]] += size
        scratch.sides[scratch.place[a], 0] = i  # the new triangle to the right of the edge from a to y
        scratch.sides[scratch.place[b], 1] = i  # and that to the left
    for i in range(number):
        right, left = scratch.sides[i, 0], scratch.sides[i, 1]
        p = scratch.centers[right, 0], scratch.centers[right, 1]
        q = scratch.centers[left, 0], scratch.centers[left, 1]
        v = _from(rows, scratch.ring[i], y)
        taken[i] -= _quarter(v, (0.0, 0.0), q, p)
        ratio = math.hypot(p[0] - q[0], p[1] - q[1]) / math.hypot(v[0], v[1])
        growth[i, 0], growth[i, 1] = ratio * (p[0] + q[0]) / 2.0, ratio * (p[1] + q[1]) / 2.0
    return number


@cached_njit(error_model="numpy")
def _old_center(cells, offsets, t, y):
    """The center of an old triangle, from y."""
    v = cells.simplices[t, 0]
    return (cells.rows[v, 0] - y[0]) + offsets[t, 0], (cells.rows[v, 1] - y[1]) + offsets[t, 1]


@cached_njit(error_model="numpy")
def _old_center_in_space(cells, offsets, t, y):
    """The center of an old tetrahedron, from y."""
    x = _from_in_space(cells.rows, cells.simplices[t, 0], y)
    return x[0] + offsets[t, 0], x[1] + offsets[t, 1], x[2] + offsets[t, 2]


@cached_njit(error_model="numpy")
def _from_in_space(rows, v, x):
    """Row v less x, in space."""
    return rows[v, 0] - x[0], rows[v, 1] - x[1], rows[v, 2] - x[2]


@cached_njit(error_model="numpy")
def _sixth(u, v, p, q):
    """What a triangle with the sides u and v gives the cells of its three corners, signed.

    p and q are the centers on its two sides, q on the one from which it is counter-clockwise. Each corner
    gets the two tetrahedra of itself, the piece of the cells' border from p to q, and half of each side.
    """
    n0, n1, n2 = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    nn = n0 * n0 + n1 * n1 + n2 * n2
    # the piece is parallel to the normal; that its ends may be far away does no harm
    height = ((q[0] - p[0]) * n0 + (q[1] - p[1]) * n1 + (q[2] - p[2]) * n2) / 24.0
    uu, vv = u[0] * u[0] + u[1] * u[1] + u[2] * u[2], v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    uv = u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
    # an edge gives both of its ends |edge|^2 cot / 8 of the triangle, with the angle opposite; these are the
    # cotangents times the root of nn
    first, second, third = uv, uu - uv, vv - uv
    ww, scale = uu + vv - 2.0 * uv, height / nn
    return (
        scale * (uu * third + vv * second),
        scale * (uu * third + ww * first),
        scale * (vv * second + ww * first),
    )


@cached_njit(error_model="numpy")
def _outward(simplices, t, k):
    """The facet opposite the k-th vertex, counter-clockwise from outside."""
    return simplices[t, OUTWARD[k, 0]], simplices[t, OUTWARD[k, 1]], simplices[t, OUTWARD[k, 2]]


@cached_njit(error_model="numpy")
def _add_facet(rows, ends, p, q, scratch):
    """Add a facet of three sites, ccw from the side of q, to what is taken of their cells."""
    a, b, c = ends
    sizes = _sixth(_from_in_space(rows, b, rows[a]), _from_in_space(rows, c, rows[a]), p, q)
    scratch.taken[scratch.place[a]] += sizes[0]
    scratch.taken[scratch.place[b]] += sizes[1]
    scratch.taken[scratch.place[c]] += sizes[2]


@cached_njit(error_model="numpy")
def _add_new_facet(rows, ends, first, second, y, scratch):
    """Take off what the new facet of y and two sites gives: of ``first`` it is (y, b, a) from outside."""
    a, b = ends
    p = scratch.centers[first, 0], scratch.centers[first, 1], scratch.centers[first, 2]
    q = scratch.centers[second, 0], scratch.centers[second, 1], scratch.centers[second, 2]
    u, v = _from_in_space(rows, a, y), _from_in_space(rows, b, y)
    sizes = _sixth(v, u, p, q)
    scratch.taken[scratch.place[b]] -= sizes[1]
    scratch.taken[scratch.place[a]] -= sizes[2]
    _add_growth(scratch.growth[scratch.place[a]], u, p, q, -1.0)
    _add_growth(scratch.growth[scratch.place[b]], v, p, q, 1.0)


@cached_njit(error_model="numpy")
def _add_growth(growth, v, p, q, sign):
    """Add the triangle of p, q and the middle of the new edge to v: its area times its centroid over |v|."""
    m0, m1, m2 = v[0] / 2.0, v[1] / 2.0, v[2] / 2.0
    b0, b1, b2, c0, c1, c2 = p[0] - m0, p[1] - m1, p[2] - m2, q[0] - m0, q[1] - m1, q[2] - m2
    volume = v[0] * (b1 * c2 - b2 * c1) + v[1] * (b2 * c0 - b0 * c2) + v[2] * (b0 * c1 - b1 * c0)
    ratio = sign * volume / (6.0 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]))
    growth[0] += ratio * (m0 + p[0] + q[0])
    growth[1] += ratio * (m1 + p[1] + q[1])
    growth[2] += ratio * (m2 + p[2] + q[2])


@cached_njit(error_model="numpy")
def _cells_in_space(cells, y, stamp, sizes, scratch):
    """Write what y takes of the cells around, and how that grows as it moves; returns how many cells."""
    count, open_facets = sizes
    rows, simplices = cells.rows, cells.simplices
    number = 0
    for i in range(open_facets):
        t, k = scratch.facets[i]
        for v in _outward(simplices, t, k):
            _, number = _local(v, scratch.place, scratch.ring, number)
    scratch.taken[:number] = 0.0
    scratch.growth[:number] = 0.0
    for i in range(count):
        t = scratch.cavity[i]
        p = _old_center_in_space(cells, scratch.offsets, t, y)
        for k in range(4):
            u = cells.neighbors[t, k]
            if u > t and scratch.seen[u] == stamp:
                q = _old_center_in_space(cells, scratch.offsets, u, y)
                _add_facet(rows, _outward(simplices, t, k), p, q, scratch)
    edges, waiting = scratch.edges, 0
    for i in range(open_facets):
        t, k = scratch.facets[i]
        p = _old_center_in_space(cells, scratch.offsets, t, y)
        q = scratch.centers[i, 0], scratch.centers[i, 1], scratch.centers[i, 2]
        ends = _outward(simplices, t, k)
        _add_facet(rows, ends, p, q, scratch)
        for j in range(3):
            a, b = ends[j], ends[(j + 1) % 3]
            at = 0
            while at < waiting and not (edges[at, 0] == b and edges[at, 1] == a):
                at += 1
            if at < waiting:
                _add_new_facet(rows, (a, b), i, edges[at, 2], y, scratch)
                waiting -= 1
                edges[at] = edges[waiting]
            else:
                edges[waiting, 0], edges[waiting, 1], edges[waiting, 2] = a, b, i
                waiting += 1
    return number


@cached_njit(error_model="numpy")
def _new_centers(cells, y, open_facets, scratch):
    """Write the centers of the new simplices, from y; whether all are reliable."""
    for i in range(open_facets):
        t, k = scratch.facets[i]
        if cells.simplices.shape[1] == 3:
            a, b = cells.simplices[t, (k + 1) % 3], cells.simplices[t, (k + 2) % 3]
            if not _center_in_plane(cells.rows, a, b, y, scratch.centers[i]):
                return False
        else:
            a, b, c = _outward(cells.simplices, t, k)
            if not _center_in_space(cells.rows, a, b, c, y, scratch.centers[i]):
                return False
    return True


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
            if sizes[0] == FLAT or not _new_centers(cells, y, sizes[1], scratch):
                continue
            if d == 2:
                number = _cells_in_plane(cells, y, stamp, sizes, scratch)
            else:
                number = _cells_in_space(cells, y, stamp, sizes, scratch)
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

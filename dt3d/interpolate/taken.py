"""What a point takes of the cells around it: pieces of cells at the facets of its cavity, and new centers.

`sibson` has the method. Sizes are signed, and relative to the point.
"""

from __future__ import annotations

import math

from .._numba.kernel_cache import cached_njit
from .._topology import OUTWARD
from ..geometry.pairs import RELIABLE, cross, dot, extent, shrinking, sides_in_plane, sides_in_space
from ..predicates import double_double as dd

WELL_SHAPED = 2.0**-16  # as in `dt3d.geometry.barycentric`


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
def cells_in_plane(cells, y, stamp, sizes, scratch):
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
def cells_in_space(cells, y, stamp, sizes, scratch):
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
def new_centers(cells, y, open_facets, scratch):
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

"""A convex polytope that planes cut, compiled: its vertices, and its faces as loops of them.

What a plane leaves is decided by the sign of each vertex alone. Each face keeps its vertices on the inner
side and gets new ones where the sign changes along its loop. A new vertex belongs to an edge, and so to two
faces, which run through it in opposite directions. So the lines that they have in the plane join to loops,
the faces that close the polytope. The surface is closed whatever rounding says about a vertex, and each
vertex is a corner of three faces; no tolerance is needed. (C. H. Rycroft: Voro++: A three-dimensional
Voronoi cell library in C++. Chaos 19, 2009, cuts cells plane by plane, too, with tolerances.)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._numba.kernel_cache import cached_njit

VERTICES, FACES = 0, 1  # entries of `size`
SIDE = 3  # of `at`: how far beyond the plane of a cut a vertex is
BEGIN, LABEL = 0, 1  # of `faces`
# of `marks`, in a cut: of a vertex its number afterwards, and the last new vertex on its edges; of a new one
# the end of its edge that is lost, the one before on edges of the same vertex, and the next one in the plane
NUMBER, CROSSED, LOST, BEFORE, AFTER = range(5)
ROOM = 64  # vertices at first


class Polytope(NamedTuple):
    """A polytope, in arrays with room for more.

    Attributes
    ----------
    size : int64 (2,)
        How many vertices and faces there are; no vertices if it is empty.
    at : float64 (v, 4)
        Where each vertex is, and `SIDE`.
    faces : int64 (2 v + 1, 2)
        Where the loop of each begins, and what it is for the caller; then where the last loop ends.
    loop : int64 (3 v,)
        Vertices around each face, counter-clockwise from outside.
    marks : int64 (v, 5)
        What a cut works with.
    """

    size: npt.NDArray[np.int64]
    at: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64]
    loop: npt.NDArray[np.int64]
    marks: npt.NDArray[np.int64]


@cached_njit
def empty_polytope(room):
    """A polytope without vertices, with room for some."""
    return Polytope(
        np.zeros(2, np.int64),
        np.empty((room, 4)),
        np.zeros((2 * room + 1, 2), np.int64),
        np.empty(3 * room, np.int64),
        np.empty((room, 5), np.int64),
    )


@cached_njit
def make_box(cell, low, high, labels):
    """Make it the box with these corners; labels of its walls, low and high for each axis in turn."""
    cell.size[VERTICES], cell.size[FACES] = 8, 6
    for i in range(8):
        for axis in range(3):
            cell.at[i, axis] = high[axis] if i >> axis & 1 else low[axis]
    for axis in range(3):
        u, v = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        for side in range(2):
            face, base = 2 * axis + side, side << axis
            cell.faces[face, LABEL], cell.faces[face + 1, BEGIN] = labels[face], 4 * face + 4
            cell.loop[4 * face] = base
            cell.loop[4 * face + 1] = base + (u if side else v)
            cell.loop[4 * face + 2] = base + u + v
            cell.loop[4 * face + 3] = base + (v if side else u)


@cached_njit
def has_room(cell):
    """Whether a cut has: it keeps at most all v vertices, and makes at most one on each of 3 v / 2 edges."""
    return 5 * cell.size[VERTICES] // 2 < len(cell.at)


@cached_njit
def cut(cell, plane, label, out):
    """Write the part of a polytope with a x + b y + c z <= d; whether that is less than the whole.

    Parameters
    ----------
    cell : Polytope
        One that `has_room`.
    plane : tuple of float
        a, b, c, d.
    label : int
        Of the faces in the plane.
    out : Polytope
        With as much room. It is not written where nothing is cut off.
    """
    kept = _keep(cell, plane, out)
    if kept == cell.size[VERTICES]:
        return False
    count, faces, end = kept, np.int64(0), np.int64(0)
    if kept:
        for face in range(cell.size[FACES]):
            before = end
            count, end = _cut_face(cell, face, count, end, out)
            if end > before:
                out.faces[faces, LABEL], out.faces[faces + 1, BEGIN] = cell.faces[face, LABEL], end
                faces += 1
    # the loops of lines in the plane
    for first in range(kept, count):
        if cell.marks[first, AFTER] < 0:
            continue
        v = first
        while cell.marks[v, AFTER] >= 0:
            out.loop[end] = v
            end += 1
            following = cell.marks[v, AFTER]
            cell.marks[v, AFTER] = -1
            v = following
        out.faces[faces, LABEL], out.faces[faces + 1, BEGIN] = label, end
        faces += 1
    out.size[VERTICES], out.size[FACES] = count, faces
    return True


@cached_njit
def _keep(cell, plane, out):
    """Write on which side of the plane each vertex is, and those that are kept; how many."""
    a, b, c, d = plane
    at, kept = cell.at, np.int64(0)
    for i in range(cell.size[VERTICES]):
        side = a * at[i, 0] + b * at[i, 1] + c * at[i, 2] - d
        at[i, SIDE] = side
        if side <= 0.0:
            cell.marks[i, NUMBER], cell.marks[i, CROSSED] = kept, -1
            for axis in range(3):
                out.at[kept, axis] = at[i, axis]
            kept += 1
    return kept


@cached_njit
def _cut_face(cell, face, count, end, out):
    """Write what is left of a face from out.loop[end] on; the number of vertices, and where it ends."""
    begin, stop = cell.faces[face, BEGIN], cell.faces[face + 1, BEGIN]
    leaves = enters = np.int64(-1)
    v = cell.loop[stop - 1]
    inside = cell.at[v, SIDE] <= 0.0
    for i in range(begin, stop):
        w = cell.loop[i]
        next_inside = cell.at[w, SIDE] <= 0.0
        if inside != next_inside:
            x = _crossing(cell, v if inside else w, w if inside else v, count, out)
            count = max(count, x + 1)
            if inside:
                leaves = x
            elif leaves >= 0:
                cell.marks[x, AFTER] = leaves
            else:
                enters = x  # the loop has left before it began
            out.loop[end] = x
            end += 1
        if next_inside:
            out.loop[end] = cell.marks[w, NUMBER]
            end += 1
        v, inside = w, next_inside
    if enters >= 0:
        cell.marks[enters, AFTER] = leaves
    return count, end


@cached_njit
def _crossing(cell, v, w, count, out):
    """The new vertex between v, which is kept, and w; its number is count if it is made now.

    Those that v has are a list: v leads to the last, and each to the one before.
    """
    at, marks = cell.at, cell.marks
    x = marks[v, CROSSED]
    while x >= 0:
        if marks[x, LOST] == w:
            return x
        x = marks[x, BEFORE]
    part = at[v, SIDE] / (at[v, SIDE] - at[w, SIDE])
    for axis in range(3):
        out.at[count, axis] = at[v, axis] + part * (at[w, axis] - at[v, axis])
    marks[count, LOST], marks[count, BEFORE], marks[v, CROSSED] = w, marks[v, CROSSED], count
    return count


@cached_njit
def volume(cell):
    """The volume: tetrahedra from one vertex to the triangles of all faces."""
    total, at = 0.0, cell.at
    for face in range(cell.size[FACES]):
        x, y, z = area_vector(cell, face)
        v = cell.loop[cell.faces[face, BEGIN]]
        total += (at[v, 0] - at[0, 0]) * x + (at[v, 1] - at[0, 1]) * y + (at[v, 2] - at[0, 2]) * z
    return max(total / 3.0, 0.0)


@cached_njit
def area_vector(cell, face):
    """The normal of a face that is as long as its area."""
    at, loop = cell.at, cell.loop
    begin, stop = cell.faces[face, BEGIN], cell.faces[face + 1, BEGIN]
    o, v = loop[begin], loop[begin + 1]
    px, py, pz = at[v, 0] - at[o, 0], at[v, 1] - at[o, 1], at[v, 2] - at[o, 2]
    x = y = z = 0.0
    for i in range(begin + 2, stop):
        v = loop[i]
        qx, qy, qz = at[v, 0] - at[o, 0], at[v, 1] - at[o, 1], at[v, 2] - at[o, 2]
        x, y, z = x + (py * qz - pz * qy), y + (pz * qx - px * qz), z + (px * qy - py * qx)
        px, py, pz = qx, qy, qz
    return x / 2.0, y / 2.0, z / 2.0

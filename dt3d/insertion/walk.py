"""The walk to a site: through any facet that has the site on its other side (O. Devillers, S. Pion, M.
Teillaud: Walking in a triangulation, International Journal of Foundations of Computer Science 13, 2002)."""

from __future__ import annotations

import numba

from .._numba.kernel_cache import cached_njit
from ..predicates.filtered import ORIENT3D_BOUND, orient3d
from .layout import INFINITE
from .ownership import owns, owns_one


@cached_njit(error_model="numpy")
def _orientation(rows, s, a, b, c):
    """Determinant of a - s, b - s, c - s, and a bound of its error."""
    x, y, z = rows[4 * s], rows[4 * s + 1], rows[4 * s + 2]
    ax, ay, az = rows[4 * a] - x, rows[4 * a + 1] - y, rows[4 * a + 2] - z
    bx, by, bz = rows[4 * b] - x, rows[4 * b + 1] - y, rows[4 * b + 2] - z
    cx, cy, cz = rows[4 * c] - x, rows[4 * c + 1] - y, rows[4 * c + 2] - z
    det = ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by)
    size = max(abs(ax), abs(bx), abs(cx)) * max(abs(ay), abs(by), abs(cy)) * max(abs(az), abs(bz), abs(cz))
    return det, ORIENT3D_BOUND * size


@cached_njit(inline="always", error_model="numpy")
def walk(points, rows, mesh, t, site, low, length, n, slack, w):
    """From t to the tetrahedron that contains a site, or a ghost whose facet it is beyond.

    ``slack`` is a bound of what underflow can do to a determinant.

    Also whether it got there, or stopped where every way on leaves what the thread may read; and the steps.
    -1 steps: it went on where no walk does. Each step goes to a tetrahedron of whose sphere, perturbed, the
    site has a lesser power (H. Edelsbrunner: An acyclicity theorem for cell complexes in d dimensions,
    Combinatorica 10, 1990), so none is visited twice, and steps are fewer than the slots.
    """
    steps = 0
    most = len(mesh) >> 3
    came = -1
    whole = length == n
    found = whole or owns_one(mesh, t, low, length, n)
    if found:
        for k in range(4):
            if mesh[8 * t + k] == INFINITE:
                t = numba.int64(mesh[8 * t + 4 + k]) >> 2
                break
    moving = found
    while moving and steps < most:
        moving = False
        found = True
        if (
            mesh[8 * t] != INFINITE
            and mesh[8 * t + 1] != INFINITE
            and mesh[8 * t + 2] != INFINITE
            and mesh[8 * t + 3] != INFINITE
        ):
            for i in range(4):
                k = (i + steps) & 3  # another first facet each time
                if k != came:
                    a = numba.int64(mesh[8 * t | k ^ 1])
                    b = numba.int64(mesh[8 * t | k ^ 2])
                    c = numba.int64(mesh[8 * t | k ^ 3])
                    det, bound = _orientation(rows, site, a, b, c)
                    bound += slack
                    if det < -bound or (not det > bound and orient3d(points, site, a, b, c, w) < 0):
                        if (
                            whole
                            or owns(a, low, length, n)
                            or owns(b, low, length, n)
                            or owns(c, low, length, n)
                        ):
                            step = numba.int64(mesh[8 * t + 4 + k])
                            t, came = step >> 2, step & 3
                            steps += 1
                            moving = True
                            break
                        found = False
    if moving:
        return t, False, -1
    return t, found, steps


@cached_njit(nogil=True, error_model="numpy")
def locate(points, rows, mesh, t, site, slack, w):
    """The tetrahedron that contains a site, or a ghost; for when no thread inserts. -1 if the walk does not
    end."""
    t, found, _ = walk(points, rows, mesh, t, site, 0, 1, 1, slack, w)
    return t if found else -1

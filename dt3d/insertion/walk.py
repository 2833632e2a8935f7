"""The walk to a site: through any facet that has the site on its other side (O. Devillers, S. Pion, M.
Teillaud: Walking in a triangulation, International Journal of Foundations of Computer Science 13, 2002)."""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from ..predicates.filtered import ORIENT3D_BOUND, orient3d
from .mesh import INFINITE, neighbor, offset, side, site_at_hand, tetrahedron, tetrahedron_of, vertex
from .ownership import Part, owns, owns_some

NEARBY = 16  # sites on either side on the curve, from one of which a walk that stopped is begun again


@cached_njit(inline="always", error_model="numpy")
def walk(mesh, t, site, part, slack, w):
    """From t to the tetrahedron that contains a site, or a ghost whose facet it is beyond.

    ``slack`` is a bound of what underflow can do to a determinant.

    Also whether it got there, or stopped where every way on leaves what the thread may read; and the steps.
    -1 steps: it went on where no walk does. Each step goes to a tetrahedron of whose sphere, perturbed, the
    site has a lesser power (H. Edelsbrunner: An acyclicity theorem for cell complexes in d dimensions,
    Combinatorica 10, 1990), so none is visited twice, and steps are fewer than the slots.
    """
    steps = 0
    most = len(mesh.tetrahedra) >> 3
    entered = -1
    whole = part.length == part.sites
    found = whole or owns_some(mesh, t, part)
    if found:
        for k in range(4):
            if vertex(mesh, t, k) == INFINITE:
                t = tetrahedron(neighbor(mesh, t, k))
                break
    moving = found
    while moving and steps < most:
        moving = False
        found = True
        if (
            vertex(mesh, t, 0) != INFINITE
            and vertex(mesh, t, 1) != INFINITE
            and vertex(mesh, t, 2) != INFINITE
            and vertex(mesh, t, 3) != INFINITE
        ):
            for i in range(4):
                k = (i + steps) & 3  # another first facet each time
                if k != entered:
                    a, b, c = vertex(mesh, t, k ^ 1), vertex(mesh, t, k ^ 2), vertex(mesh, t, k ^ 3)
                    det, bound = _orientation(mesh, site, a, b, c)
                    bound += slack
                    if det < -bound or (not det > bound and orient3d(mesh.points, site.v, a, b, c, w) < 0):
                        if whole or owns(part, a) or owns(part, b) or owns(part, c):
                            beyond = neighbor(mesh, t, k)
                            t, entered = tetrahedron(beyond), side(beyond)
                            steps += 1
                            moving = True
                            break
                        found = False
    if moving:
        return t, False, -1
    return t, found, steps


@cached_njit(inline="always", error_model="numpy")
def _orientation(mesh, site, a, b, c):
    """Determinant of a - s, b - s, c - s, and a bound of its error."""
    ax, ay, az = offset(mesh, a, site)
    bx, by, bz = offset(mesh, b, site)
    cx, cy, cz = offset(mesh, c, site)
    det = ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by)
    size = max(abs(ax), abs(bx), abs(cx)) * max(abs(ay), abs(by), abs(cy)) * max(abs(az), abs(bz), abs(cz))
    return det, ORIENT3D_BOUND * size


@cached_njit(inline="always", error_model="numpy")
def nearby_start(mesh, v, part):
    """A tetrahedron of a site near v on the curve that the thread owns; -1 if none is known."""
    t = -1
    for i in range(2, 2 * NEARBY + 2):
        u = v + (i >> 1 if i & 1 else -(i >> 1))
        if 0 <= u < part.sites and owns(part, u) and tetrahedron_of(mesh, u) >= 0:
            t = tetrahedron_of(mesh, u)
            break
    return t


@cached_njit(nogil=True, error_model="numpy")
def locate(mesh, t, v, slack, w):
    """The tetrahedron that contains site v, or a ghost; for when no thread inserts. -1 if the walk does not
    end."""
    mesh, w = unowned(mesh), unowned(w)
    t, found, _ = walk(mesh, t, site_at_hand(mesh, v), Part(0, 1, 1), slack, w)
    return t if found else -1

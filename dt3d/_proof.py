"""A proof that simplices are the Delaunay triangulation of their sites, in the plane and in space.

Words for space; in the plane read triangle, edge and vertex for tetrahedron, facet and edge. Each sentence
is a finite number of exact signs or a comparison of indices:

1. every site is a vertex, or equals one;
2. no tetrahedron is flat (negative ones are turned first, by exchanging two vertices);
3. no two tetrahedra have a facet in common and lie on the same side of it;
4. no vertex of a neighbour is inside the sphere across the common facet;
5. a point x inside the first tetrahedron is in no other one;
6. x is strictly behind every facet of the hull, which are those with one tetrahedron only;
7. the hull is convex along each of its edges.

**Theorem.** Then, and only then, they are a Delaunay triangulation of the sites.

*They tile a star.* Let w(y) count the tetrahedra that contain y, and B be the hull's facets, facing outwards.
By (2) and (3) the boundary of the sum of all tetrahedra is the sum of B: where two meet, the facet cancels.
So the sum of the tetrahedra and the sum of the cones from x over B have the same boundary, and are the same
for almost all y, since no chain of tetrahedra in space but zero is without boundary. By (6) all cones count
positively. So w(y) is the number of cones that contain y. Near x it is 1, by (5), and there the cones are
counted by rays: almost every ray from x meets B once. So the cones, and with them the tetrahedra, cover
without overlap a body K that is a star about x and bounded by B. (A mesh that winds twice, or has two sheets,
fails here: where hull facets turn their backs to x, w(x) counts how often the hull goes round.)

*The star is convex.* Almost every plane through x misses the vertices of B. It cuts K in a polygon, a star
about x, whose corners lie on edges of B and are convex by (7), so in a convex polygon. So the segment between
almost any two points of K is in K; K is closed, hence convex. It is the convex hull of the sites. (That local
convexity is enough for closed connected sets: H. Tietze 1928, S. Nakajima 1928. That for a closed surface of
triangles with (6) and (7) one ray decides: K. Mehlhorn et al., Checking geometric programs or verification of
geometric structures, Computational Geometry 12, 1999.)

*It is face to face.* Within K, the tetrahedron beyond a facet is the one that shares the facet. So
those around a point p that have p as a vertex are never left by crossing facets at p, and every tetrahedron
that contains p has it as a vertex. In particular equal sites are not both vertices: a tetrahedron with both
would be flat.

*It is Delaunay* (B. Delaunay, Sur la sphere vide, 1934). From a point inside a tetrahedron walk straight to a
site p, through insides of facets. By (4) the power of p with respect to the sphere of the tetrahedron that
the walk is in does not increase from one to the next, and in the last, of which p is a vertex, it is 0. So p
is not inside the first sphere. With the infinitesimal heights of the symbolic perturbation the same walk
shows that it is the one triangulation that the perturbation defines.

The other direction holds since K is then convex and tiled once, whatever x is.

The point x is a + e (b - a) + e^2 (c - a) + e^3 (d - a) for an infinitesimal e and the first tetrahedron
abcd. It lies on no plane of sites; its side of a plane is that of the first of a, b, c, d that is not on it.

(5), (6) and (7) are about what (2) and (3) establish. Where one of those fails, the later sentences are not
checked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _topology
from ._input import check_points, exactly_scaled, first_copies
from ._memory import require
from ._mesh_input import check_duplicates, check_neighbors, check_simplices
from .predicates import work_array

BYTES_PER_CORNER = 60  # of all simplices, at least, as measured


@dataclass(frozen=True)
class Verification:
    """The outcome: true if all invariants hold; printed, one sentence for each.

    Attributes
    ----------
    invariants : tuple of (str, int or None)
        What must hold, and how often it does not; None where it was not checked, since it has no meaning as
        long as an earlier one is broken.
    remarks : tuple of str
        What is worth knowing and breaks nothing.

    Examples
    --------
    >>> import dt3d
    >>> proof = dt3d.Delaunay([[0, 0], [2, 0], [0, 2]]).verify()
    >>> bool(proof), {broken for _, broken in proof.invariants}
    (True, {0})
    """

    invariants: tuple[tuple[str, int | None], ...]
    remarks: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return all(broken == 0 for _, broken in self.invariants)

    def __str__(self) -> str:
        return "\n".join(
            [_sentence(*pair) for pair in self.invariants] + [f"remark: {r}" for r in self.remarks]
        )


def _sentence(what: str, broken: int | None) -> str:
    if broken is None:
        return f"not checked: {what}"
    return f"broken: {what} ({broken} times not)" if broken else f"holds: {what}"


@dataclass(frozen=True)
class Space:
    """What the proof needs to know of the plane or of space: words, indices, and compiled signs.

    Attributes
    ----------
    words : dict of str to str
        "simplex", "simplices", "facet", "ball", "ridge".
    outward : int (d + 1, d)
        Row k: the facet opposite the k-th vertex of a positive simplex, as its hull facet is oriented.
    orientations(sites, simplices, w) : int8 (m,)
    count_inside(sites, simplices, apex, perturbed, w) : int
        Rows whose apex is inside the circumsphere.
    count_containing(sites, simplices, w) : int
        Simplices other than the first that contain the point x.
    count_facing(sites, simplex, hull, w) : int
        Hull facets that x is not behind.
    dents(sites, hull, w) : int
        Ridges of the hull with more than two facets, or along which it bends inwards.
    """

    words: dict[str, str]
    outward: np.ndarray
    orientations: Callable[..., np.ndarray]
    count_inside: Callable[..., int]
    count_containing: Callable[..., int]
    count_facing: Callable[..., int]
    dents: Callable[..., int]


def prove(
    space: Space,
    points: npt.ArrayLike,
    simplices: npt.ArrayLike,
    *,
    neighbors: npt.ArrayLike | None,
    duplicates: npt.ArrayLike | None,
    perturbed: bool,
    oriented: bool,
) -> Verification:
    """Check the sentences of this module; `dt3d.verification.verify` has the parameters.

    MemoryError if the system does not have the memory.
    """
    corners, words = len(space.outward), space.words
    points = check_points(points, corners - 1)
    simplices = check_simplices(simplices, len(points), corners, words["simplices"])
    if neighbors is not None:
        neighbors = check_neighbors(neighbors, len(simplices), corners)
    if duplicates is not None:
        duplicates = check_duplicates(duplicates, len(points))
    require(f"verifying {len(simplices)} {words['simplices']}", BYTES_PER_CORNER * simplices.size)
    sites = np.ascontiguousarray(exactly_scaled(points))
    w = work_array(sites)

    signs = space.orientations(sites, simplices, w)
    turned = signs < 0
    remarks = []
    if turned.any():
        simplices = _turn(simplices, turned)
        neighbors = None if neighbors is None else _turn(neighbors, turned)
        if not oriented:
            how_many = f"{turned.sum()} of {len(signs)} {words['simplices']}"
            remarks.append(f"{how_many} are negatively oriented, and were turned first")
    checks = _Checks()
    checks.add("every site is a vertex, or a duplicate of one", lambda: _lost(points, simplices, duplicates))
    if oriented:
        checks.add(f"every {words['simplex']} is positively oriented", lambda: int(turned.sum()))
    checks.add(f"no {words['simplex']} is flat", lambda: int((signs == 0).sum()), needed=True)
    if not len(simplices):
        checks.stop()

    pairs, crowded = np.empty((0, 2), np.int64), 0
    if not checks.stopped:
        pairs, crowded = _topology.matched(simplices[:, space.outward].reshape(-1, corners - 1))
    what = f"{words['facet']} has at most one {words['simplex']} on each side"
    checks.add(f"every {what}", lambda: crowded, needed=True)
    if neighbors is not None:
        checks.add("neighbors says which ones", lambda: _misnamed(neighbors, pairs))
    ties = ", ties decided by the perturbation" if perturbed else ""
    checks.add(
        f"no site is inside the {words['ball']} across {words['a facet']}{ties}",
        # one side is enough: the other one has the same sign
        lambda: space.count_inside(
            sites, simplices[pairs[:, 0] // corners], simplices.ravel()[pairs[:, 1]], perturbed, w
        ),
    )
    checks.add(
        f"a point inside the first {words['simplex']} is in no other one",
        lambda: space.count_containing(sites, simplices, w),
    )
    hull = np.empty((0, corners - 1), np.int32) if checks.stopped else _hull(space, simplices, pairs)
    checks.add(
        f"that point is behind every {words['facet']} of the hull",
        lambda: space.count_facing(sites, simplices[0], hull, w),
    )
    checks.add(f"the hull is convex {words['at every ridge']}", lambda: space.dents(sites, hull, w))
    return Verification(tuple(checks.outcome), tuple(remarks))


class _Checks:
    """Sentences in order; after a needed one that is broken the others have no meaning."""

    def __init__(self) -> None:
        self.outcome: list[tuple[str, int | None]] = []
        self.stopped = False

    def add(self, what: str, count: Callable[[], int], needed: bool = False) -> None:
        broken = None if self.stopped else int(count())
        self.outcome.append((what, broken))
        if needed and broken:
            self.stop()

    def stop(self) -> None:
        self.stopped = True


def _turn(rows: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Rows with their first two entries exchanged where ``turned``; a copy."""
    rows = rows.copy()
    rows[turned, :2] = rows[turned, 1::-1]
    return rows


def _lost(points: np.ndarray, simplices: np.ndarray, duplicates: np.ndarray | None) -> int:
    """Sites that are neither a vertex nor equal to one; by the pairs, if there are any."""
    used = np.zeros(len(points), bool)
    used[simplices] = True
    if duplicates is not None:
        # each site is a vertex or listed, once; what is listed equals a vertex
        named = used + np.bincount(duplicates[:, 0], minlength=len(points))
        copy, vertex = duplicates.T
        false = (points[copy] != points[vertex]).any(axis=1) | ~used[vertex]
        return int((named != 1).sum() + false.sum())
    if used.all():
        return 0
    first = np.arange(len(points))  # of equal sites the first one stands for all
    copy, original = first_copies(points)[1].T
    first[copy] = original
    stands = np.zeros(len(points), bool)
    stands[first[used]] = True
    return int((~stands[first]).sum())


def _misnamed(neighbors: np.ndarray, pairs: np.ndarray) -> int:
    """Entries of ``neighbors`` that are not the simplex across the facet."""
    corners = neighbors.shape[1]
    across = np.full(neighbors.size, _topology.OUTSIDE, np.int64)
    across[pairs[:, 0]], across[pairs[:, 1]] = pairs[:, 1] // corners, pairs[:, 0] // corners
    return int((neighbors.ravel() != across).sum())


def _hull(space: Space, simplices: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """The facets that no other simplex has, int (h, d), oriented outwards."""
    alone = np.ones(simplices.size, bool)
    alone[pairs] = False
    t, k = np.divmod(np.flatnonzero(alone), simplices.shape[1])
    return np.asarray(simplices[t[:, None], space.outward[k]])

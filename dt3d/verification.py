"""Proving that tetrahedra are the Delaunay triangulation of their sites, with exact arithmetic.

If neighbouring tetrahedra lie on opposite sides of the facet they share, none has the far vertex of a
neighbour inside its circumsphere, and what borders nothing is a convex surface that they fill once, then
they are the Delaunay triangulation (B. Delaunay, Sur la sphere vide, 1934). That is what is checked, with
exact signs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numba
import numpy as np

from . import _topology
from ._input import exactly_scaled, first_copies
from ._memory import require
from .predicates import orient3d, work_array
from .predicates.filtered import in_sphere
from .predicates.perturbed import inside

BYTES_PER_TETRAHEDRON = 450  # as measured


@dataclass(frozen=True)
class Verification:
    """The outcome: true if all invariants hold; printed, one sentence for each.

    Attributes
    ----------
    invariants : tuple of (str, int)
        What must hold, and how often it does not.
    """

    invariants: tuple[tuple[str, int], ...]

    def __bool__(self) -> bool:
        return all(not broken for _, broken in self.invariants)

    def __str__(self) -> str:
        return "\n".join(
            f"{'broken' if broken else 'holds'}: {what}" + (f" ({broken} times not)" if broken else "")
            for what, broken in self.invariants
        )


def verify(
    points: Any, simplices: Any, *, neighbors: Any = None, duplicates: Any = None, perturbed: bool = False
) -> Verification:
    """Check every invariant of a Delaunay triangulation exactly.

    Parameters
    ----------
    points : float64 (n, 3)
    simplices : int (m, 4)
        In positive orientation: det[b-a, c-a, d-a] > 0.
    neighbors : int (m, 4), optional
        Checked where given: the k-th opposite the k-th vertex, -1 beyond the hull.
    duplicates : int (k, 2), optional
        Sites that need no tetrahedron, and the equal ones that have; found here if left out.
    perturbed : bool
        Also decide cospherical sites: the triangulation must be the one that dt3d's symbolic perturbation
        gives.

    Raises
    ------
    ValueError
        If a coordinate is not finite, or indices are out of range.
    MemoryError
        If the system does not have the memory.
    """
    points, simplices = np.asarray(points, np.float64), np.asarray(simplices, np.int64).reshape(-1, 4)
    if len(simplices) and not 0 <= simplices.min() <= simplices.max() < len(points):
        named = f"{simplices.min()} to {simplices.max()}"
        msg = f"simplices name sites {named}, but there are {len(points)} points"
        raise ValueError(msg)
    require(f"verifying {len(simplices)} tetrahedra", BYTES_PER_TETRAHEDRON * len(simplices))
    sites = exactly_scaled(points)

    volumes = orient3d(*(sites[simplices[:, k]] for k in range(4)))
    adjacent, crowded = _adjacent(simplices)
    checks = [
        ("every site is a vertex, or a duplicate of one", _lost(points, simplices, duplicates)),
        ("every tetrahedron is positively oriented", int((volumes <= 0).sum())),
        ("every facet is shared by at most two tetrahedra", crowded),
    ]
    if neighbors is not None:
        checks.append(("neighbors says which ones", int((np.asarray(neighbors) != adjacent).sum())))
    hull = _topology.hull_facets(simplices, adjacent)
    inside_spheres = _violations(sites, simplices, adjacent, perturbed)
    checks += [
        ("no site is inside the sphere across a facet", inside_spheres),
        ("the hull is closed and convex along every edge", _dents(sites, hull)),
        ("vertices - edges + facets - tetrahedra = 1 (Euler)", abs(_euler(simplices, adjacent) - 1)),
    ]
    return Verification(tuple(checks))


def _lost(points: np.ndarray, simplices: np.ndarray, duplicates: Any) -> int:
    """Sites that are in no tetrahedron and not listed, and listed ones that equal no vertex."""
    if duplicates is None:
        used, copies = first_copies(points)
        named = np.isin(copies, simplices)
        return len(np.setdiff1d(used, simplices)) - int((named[:, 0] & ~named[:, 1]).sum())
    pairs = np.asarray(duplicates).reshape(-1, 2)
    missing = np.setdiff1d(np.arange(len(points)), np.concatenate([simplices.ravel(), pairs[:, 0]]))
    false = (points[pairs[:, 0]] != points[pairs[:, 1]]).any(axis=1) | ~np.isin(pairs[:, 1], simplices)
    return len(missing) + int(false.sum())


def _adjacent(simplices: np.ndarray) -> tuple[np.ndarray, int]:
    """Neighbours by their common facets, int64 (m, 4), and the number of facets with more than two sides."""
    facets = np.sort(simplices[:, _topology.OUTWARD].reshape(-1, 3), axis=1)
    order = np.lexsort(facets.T)
    same = (facets[order][1:] == facets[order][:-1]).all(axis=1)
    adjacent = np.full(4 * len(simplices), _topology.OUTSIDE, np.int64)
    first, second = order[:-1][same], order[1:][same]
    adjacent[first], adjacent[second] = second // 4, first // 4
    return adjacent.reshape(-1, 4), int((same[1:] & same[:-1]).sum())


def _violations(sites: np.ndarray, simplices: np.ndarray, adjacent: np.ndarray, perturbed: bool) -> int:
    t, k = np.nonzero(adjacent >= 0)
    other = simplices[adjacent[t, k]]
    # the vertex of the neighbour that the facet does not have
    shared = (other[:, :, None] == simplices[t][:, None, :]).any(axis=2)
    apex = other[np.arange(len(other)), shared.argmin(axis=1)]
    return _count_inside(sites, simplices[t], apex, perturbed, work_array(sites))


@numba.njit(cache=True)
def _count_inside(sites, tetrahedra, apex, perturbed, w):
    count = 0
    for i in range(len(apex)):
        v = tetrahedra[i, 0], tetrahedra[i, 1], tetrahedra[i, 2], tetrahedra[i, 3]
        if perturbed:
            count += inside(sites, v, apex[i], w)
        else:
            count += in_sphere(sites, v[0], v[1], v[2], v[3], apex[i], w) > 0
    return count


def _dents(sites: np.ndarray, hull: np.ndarray) -> int:
    """Edges of the hull that are open, or along which it bends inwards."""
    if not len(hull):
        return 1
    turns = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
    edges = np.concatenate([hull[:, t] for t in turns]).astype(np.int64)
    forth, back = edges[:, 0] << 32 | edges[:, 1], edges[:, 1] << 32 | edges[:, 0]
    order = np.argsort(forth)
    at = np.minimum(np.searchsorted(forth[order], back), len(order) - 1)
    paired = forth[order][at] == back
    opposite = edges[order][at][paired, 2]
    u, v, w = edges[paired].T
    # seen from outside u, v, w turn to the left, so sites beyond the facet have negative orientation
    bent = orient3d(sites[u], sites[v], sites[w], sites[opposite]) > 0
    doubled = len(forth) - len(np.unique(forth))
    return int((~paired).sum() + bent.sum() + doubled)


def _euler(simplices: np.ndarray, adjacent: np.ndarray) -> int:
    pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    ends = np.sort(np.concatenate([simplices[:, p] for p in pairs]), axis=1)
    edges = len(np.unique(ends[:, 0] << 32 | ends[:, 1]))
    outer = int((adjacent < 0).sum())
    facets = (4 * len(simplices) + outer) // 2
    return len(np.unique(simplices)) - edges + facets - len(simplices)

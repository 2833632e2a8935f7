"""The rounds of a finished triangulation are those in which the paper's loop finds it."""

import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d.extrapolation.compiled import tables
from dt3d.extrapolation.rounds import rounds_of

RNG = np.random.default_rng(8)
SETS = {"uniform": RNG.random((tables.FEWEST_SITES, 3)), "gauss": RNG.normal(size=(300, 3))}


def by_hand(points, simplices, neighbors):
    """Depths from the first facets, by search through all facets of a site."""
    first = set()
    for a in range(len(points)):
        others = np.flatnonzero(np.arange(len(points)) != a)
        b = others[np.argmin(((points[others] - points[a]) ** 2).sum(axis=1))]
        best = (np.inf, None)
        for t in np.flatnonzero((simplices == a).any(axis=1) & (simplices == b).any(axis=1)):
            for k in range(4):
                facet = np.delete(simplices[t], k)
                if a in facet and b in facet:
                    p, q, r = points[facet]
                    u, v, w = (np.linalg.norm(x) for x in (q - r, r - p, p - q))
                    radius = u * v * w / np.linalg.norm(np.cross(q - p, r - p))
                    best = min(best, (radius, (t, k)))
        first.add(best[1])
    depth = np.zeros(len(simplices), int)
    now = {t for t, _ in first} | {int(neighbors[t, k]) for t, k in first} - {-1}
    level = 0
    while now:
        level += 1
        depth[list(now)] = level
        now = {int(u) for t in now for u in neighbors[t] if u >= 0 and depth[u] == 0}
    return depth


def test_depths_are_those_by_hand():
    points = RNG.random((120, 3))
    points = points[np.lexsort(points.T[::-1])]
    tri = dt3d.Delaunay(points)
    rounds, per_round = rounds_of(points, tri.simplices, tri.neighbors)
    np.testing.assert_array_equal(rounds, by_hand(points, tri.simplices, tri.neighbors))
    assert np.bincount(rounds)[1:].tolist() == per_round[: rounds.max()]
    assert sum(per_round) == len(rounds)


@pytest.mark.parametrize("name", SETS)
def test_the_loop_goes_through_the_same_rounds(name):
    # other options than the default ones are not those of compiled steps
    tri = dt3d.Delaunay(SETS[name], method="extrapolation", sites_per_warrant=9)
    assert tri.stats.waves == ()
    order = np.lexsort(SETS[name].T[::-1])
    place = np.argsort(order)
    rounds, per_round = rounds_of(SETS[name][order], place[tri.simplices].astype(np.int32), tri.neighbors)
    np.testing.assert_array_equal(rounds, tri.iteration)
    assert tuple(per_round) == tri.stats.tetrahedra_per_iteration


@pytest.mark.slow
def test_compiled_steps_count_rounds_and_waves():
    points = SETS["uniform"]
    ours = dt3d.Delaunay(points, machine=sv.Device())
    theirs = dt3d.Delaunay(points, machine=sv.Device(), sites_per_warrant=9)
    assert len(ours.stats.waves) > ours.stats.iterations
    assert sum(ours.stats.waves) == len(ours.simplices)
    np.testing.assert_array_equal(ours.simplices, theirs.simplices)
    np.testing.assert_array_equal(ours.iteration, theirs.iteration)
    assert ours.stats.tetrahedra_per_iteration == theirs.stats.tetrahedra_per_iteration

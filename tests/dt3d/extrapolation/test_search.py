"""Buckets and the searches over them, against brute force."""

import numpy as np
import pytest

import scanvec as sv
from dt3d.extrapolation import buckets as buckets_module
from dt3d.extrapolation import cell_requests
from dt3d.extrapolation.boxes import cell_of
from dt3d.extrapolation.buckets import bucket, morton_code
from dt3d.extrapolation.exact.expansion import FILTERED, open_face
from dt3d.extrapolation.expansion import expand_perturbed, search_faces
from dt3d.extrapolation.faces import Face
from dt3d.extrapolation.gift_wrapping import NEAREST, Start, first_facets, squared_distance_to_box
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.search import search
from dt3d.extrapolation.tree import boxes as tree
from dt3d.extrapolation.warrants import NO_SITE

MACHINE = sv.Device()
RNG = np.random.default_rng(0)
SETS = {
    "uniform": RNG.random((300, 3)),
    "clusters": RNG.random((6, 3))[RNG.integers(6, size=300)] + 0.01 * RNG.standard_normal((300, 3)),
    "surface": np.c_[RNG.random((300, 2)), 0.02 * RNG.random(300)],
    "six sites": RNG.random((6, 3)),
}


@pytest.fixture(params=["cells", "tree"])
def load(request, monkeypatch):
    """Buckets of points, whose searches go through cells or through a tree."""
    monkeypatch.setattr(buckets_module, "EVENNESS", np.inf if request.param == "cells" else 0)
    return lambda points: bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T)))


def in_order(buckets):
    return np.stack([v.to_numpy() for v in buckets.sites], axis=1)


@pytest.mark.parametrize("name", SETS)
def test_buckets(name, load):
    points = SETS[name]
    buckets = load(points)
    np.testing.assert_array_equal(in_order(buckets), points[buckets.origin.to_numpy()])
    assert sorted(buckets.origin.to_numpy().tolist()) == list(range(len(points)))
    if buckets.cells is None:
        return
    grid, starts, counts = buckets.cells[0], buckets.cells.starts.to_numpy(), buckets.cells.counts.to_numpy()
    assert len(counts) == grid.nx * grid.ny * grid.nz
    assert counts.sum() == len(points)
    cells = MACHINE.map(cell_of, buckets.sites, grid).to_numpy()
    for cell in np.flatnonzero(counts):
        assert (cells[starts[cell] : starts[cell] + counts[cell]] == cell).all()


def test_sites_that_fill_space_evenly_get_cells():
    sets = SETS | {
        "plane": np.c_[RNG.random((3000, 2)), np.zeros(3000)],
        "normal": RNG.standard_normal((3000, 3)),
    }
    even = {
        name: bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T))).cells is not None
        for name, points in sets.items()
    }
    assert even["uniform"]
    assert even["plane"]  # the cells are squares
    assert not even["clusters"]


def test_morton_codes():
    i, j, k = (
        MACHINE.vector(np.array(v))
        for v in ([1, 0, 0, 5, 2**21 - 1], [0, 1, 0, 0, 2**21 - 1], [0, 0, 1, 0, 2**21 - 1])
    )
    assert MACHINE.map(morton_code, i, j, k).to_numpy().tolist() == [1, 2, 4, 0b1000001, 2**63 - 1]


def test_sites_with_equal_codes_get_finer_ones():
    cluster = RNG.random((200, 3)) * 2.0**-40
    points = np.concatenate([cluster, cluster + 1])
    buckets = bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T)))
    ordered = in_order(buckets)
    # a curve through a cluster is far shorter than a walk in no order
    steps = np.linalg.norm(np.diff(ordered[:200], axis=0), axis=1)
    assert steps.sum() < 0.5 * np.linalg.norm(np.diff(points[:200], axis=0), axis=1).sum()


@pytest.mark.parametrize("n", [1, 8, 9, 64, 65, 600])
def test_the_tree_holds_every_site_once_on_every_level(n):
    points = RNG.random((n, 3))
    built = tree.build(Point(*(MACHINE.vector(c.copy()) for c in points.T)))
    low, high = (np.stack([v.to_numpy() for v in p], axis=1) for p in (built.low, built.high))
    for level, (first, size) in enumerate(zip(built.first, built.sizes, strict=True)):
        for node in range(size):
            own = points[node * 8 ** (level + 1) : (node + 1) * 8 ** (level + 1)]
            np.testing.assert_array_equal(low[first + node], own.min(axis=0))
            np.testing.assert_array_equal(high[first + node], own.max(axis=0))
    assert built.sizes[-1] <= 8


def test_a_descent_finds_every_leaf_that_admits(monkeypatch):
    points = RNG.random((600, 3))
    sites = Point(*(MACHINE.vector(c.copy()) for c in points.T))
    built = tree.build(sites)
    radius = MACHINE.vector(np.linspace(0.01, 0.5, 50))
    centre = sv.get(sites, MACHINE.iota(50))
    test = tree.entry_test(_ball_meets)
    for most in (tree.MOST_NODE_REQUESTS, 40):
        monkeypatch.setattr(tree, "MOST_NODE_REQUESTS", most)
        batches = list(tree.descend(built, (centre, radius), test))
        query = np.concatenate([b.query.to_numpy() for b in batches])
        leaf = np.concatenate([b.node.to_numpy() for b in batches])
        assert (np.diff(query) >= 0).all()
        low, high = (
            np.stack([v.to_numpy() for v in p], axis=1)[: built.sizes[0]] for p in (built.low, built.high)
        )
        for q in range(50):
            gap = np.maximum(np.maximum(low - points[q], points[q] - high), 0)
            want = np.flatnonzero((gap**2).sum(axis=1) <= radius.to_numpy()[q] ** 2)
            assert sorted(leaf[query == q].tolist()) == want.tolist()


def _ball_meets(ball, low, high):
    centre, radius = ball
    return squared_distance_to_box(centre, low, high) <= radius * radius


def nearest(buckets):
    n = len(buckets.origin)
    return search(buckets, Start(buckets.sites, MACHINE.iota(n)), (buckets.sites, buckets.sites), NEAREST)


@pytest.mark.parametrize("name", SETS)
def test_nearest_site(name, load):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    answer = nearest(buckets)
    squared = ((sites[:, None] - sites) ** 2).sum(axis=2)
    np.fill_diagonal(squared, np.inf)
    np.testing.assert_array_equal(answer.best.site.to_numpy(), squared.argmin(axis=1))
    np.testing.assert_allclose(answer.best.high.to_numpy(), squared.min(axis=1), rtol=1e-14)
    assert len(sites) <= answer.sites_searched <= (len(sites) + 8) ** 2


def circumradii(a, b, c):
    """Circumradii of the triangles a, b, c[i] by Heron's formula; inf where flat."""
    u, v, w = np.linalg.norm(b - a), np.linalg.norm(c - a, axis=1), np.linalg.norm(c - b, axis=1)
    s = (u + v + w) / 2
    area = np.sqrt(np.maximum(s * (s - u) * (s - v) * (s - w), 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(area > 0, u * v * w / (4 * area), np.inf)


@pytest.mark.parametrize("name", SETS)
def test_first_facets(name, load):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    a, b, c = (v.to_numpy() for v in first_facets(buckets))
    np.testing.assert_array_equal(a, np.arange(len(sites)))
    for i, j, k in zip(a, b, c, strict=True):
        radii = circumradii(sites[i], sites[j], sites)
        radii[[i, j]] = np.inf
        assert len({i, j, k}) == 3
        assert radii[k] <= radii.min() * (1 + 1e-6)  # Heron's formula loses half the digits of flat triangles


def fourth_vertex(sites, a, b, c):
    """The site of the face's positive side with the empty sphere, by solving for every centre; or NO_SITE."""
    normal = np.cross(sites[b] - sites[a], sites[c] - sites[a])
    offsets = sites - sites[a]
    candidates = np.flatnonzero(offsets @ normal > 1e-12)
    best, least = NO_SITE, np.inf
    for d in candidates:
        rows = np.stack([offsets[b], offsets[c], offsets[d]])
        centre = np.linalg.solve(rows, (rows**2).sum(axis=1) / 2)
        if centre @ normal < least:
            best, least = d, centre @ normal
    return best


@pytest.mark.parametrize("name", SETS)
def test_face_expansion(name, load):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    faces = np.array([RNG.permutation(len(sites))[:3] for _ in range(60)], np.int32)  # mostly long ones
    faces = Face(*(MACHINE.vector(f.copy()) for f in faces.T))
    want = [fourth_vertex(sites, *face) for face in np.stack([v.to_numpy() for v in faces], axis=1)]
    answer = expand_perturbed(buckets, faces)
    np.testing.assert_array_equal(answer.best.site.to_numpy(), want)

    corners = [sv.get(buckets.sites, v) for v in faces]
    queries = MACHINE.map(open_face, faces, *corners, False)
    bounded = search_faces(buckets, queries, corners, FILTERED).best
    decided = bounded.second.to_numpy() > bounded.high.to_numpy()
    assert decided.sum() >= np.count_nonzero(np.array(want) != NO_SITE) - 1
    np.testing.assert_array_equal(bounded.site.to_numpy()[decided], np.array(want)[decided])


def test_queries_wait_where_memory_is_bounded(monkeypatch):
    buckets = bucket(Point(*(MACHINE.vector(c.copy()) for c in SETS["uniform"].T)))
    free = nearest(buckets)
    monkeypatch.setattr(cell_requests, "MOST_CELL_REQUESTS", 64)
    bounded = nearest(buckets)
    np.testing.assert_array_equal(bounded.best.site.to_numpy(), free.best.site.to_numpy())
    assert bounded.sites_searched == free.sites_searched

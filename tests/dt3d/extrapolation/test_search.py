"""Buckets and the searches over them, against brute force."""

import numpy as np
import pytest

import scanvec as sv
from dt3d.extrapolation import search as search_module
from dt3d.extrapolation.boxes import cell_of
from dt3d.extrapolation.buckets import MOST_CELLS_PER_SITE, bucket
from dt3d.extrapolation.expansion import Face, expand
from dt3d.extrapolation.gift_wrapping import NEAREST, Start, first_facets
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.search import NO_SITE, search

MACHINE = sv.Device()
RNG = np.random.default_rng(0)
SETS = {
    "uniform": RNG.random((300, 3)),
    "clusters": RNG.random((6, 3))[RNG.integers(6, size=300)] + 0.01 * RNG.standard_normal((300, 3)),
    "surface": np.c_[RNG.random((300, 2)), 0.02 * RNG.random(300)],
    "six sites": RNG.random((6, 3)),
}


def load(points):
    return bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T)))


def in_order(buckets):
    return np.stack([v.to_numpy() for v in buckets.sites], axis=1)


@pytest.mark.parametrize("name", SETS)
def test_buckets(name):
    points = SETS[name]
    buckets = load(points)
    np.testing.assert_array_equal(in_order(buckets), points[buckets.origin.to_numpy()])
    assert sorted(buckets.origin.to_numpy().tolist()) == list(range(len(points)))
    starts, counts = buckets.starts.to_numpy(), buckets.counts.to_numpy()
    grid = buckets.grid
    assert len(counts) == grid.nx * grid.ny * grid.nz <= 2 * MOST_CELLS_PER_SITE * len(points) + 1
    assert counts.sum() == len(points)
    np.testing.assert_array_equal(starts, np.cumsum(counts) - counts)
    cells = MACHINE.map(cell_of, buckets.sites, grid).to_numpy()
    np.testing.assert_array_equal(cells, np.repeat(np.arange(len(counts)), counts))


@pytest.mark.parametrize("name", SETS)
def test_nearest_site(name):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    answer = search(buckets, Start(buckets.sites, MACHINE.iota(len(sites))), NEAREST)
    squared = ((sites[:, None] - sites) ** 2).sum(axis=2)
    np.fill_diagonal(squared, np.inf)
    np.testing.assert_array_equal(answer.site.to_numpy(), squared.argmin(axis=1))
    np.testing.assert_allclose(answer.score.to_numpy(), squared.min(axis=1), rtol=1e-14)
    assert len(sites) <= answer.sites_searched <= len(sites) ** 2


def circumradii(a, b, c):
    """Circumradii of the triangles a, b, c[i] by Heron's formula; inf where flat."""
    u, v, w = np.linalg.norm(b - a), np.linalg.norm(c - a, axis=1), np.linalg.norm(c - b, axis=1)
    s = (u + v + w) / 2
    area = np.sqrt(np.maximum(s * (s - u) * (s - v) * (s - w), 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(area > 0, u * v * w / (4 * area), np.inf)


@pytest.mark.parametrize("name", SETS)
def test_first_facets(name):
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
def test_face_expansion(name):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    faces = np.array([RNG.permutation(len(sites))[:3] for _ in range(60)], np.int32)  # mostly long ones
    answer = expand(buckets, Face(*(MACHINE.vector(f.copy()) for f in faces.T)))
    want = [fourth_vertex(sites, *face) for face in faces]
    np.testing.assert_array_equal(answer.site.to_numpy(), want)


def test_queries_wait_where_memory_is_bounded(monkeypatch):
    buckets = load(SETS["uniform"])
    start = Start(buckets.sites, MACHINE.iota(300))
    free = search(buckets, start, NEAREST)
    monkeypatch.setattr(search_module, "MOST_REQUESTS", 64)
    bounded = search(buckets, start, NEAREST)
    np.testing.assert_array_equal(bounded.site.to_numpy(), free.site.to_numpy())
    assert bounded.sites_searched == free.sites_searched

"""Subdivision, flips and legalisation: neighbours, the history, and Delaunay in the end."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.dag import locate
from dt3d.threaded2d.flips import flip, illegal, insert, subdivide

from .families import uniform
from .runs import half_inserted
from .stepping import across, assert_delaunay, conflicts, leaf_pairs, leaves


def assert_neighbours(store):
    """Each edge names the triangle on the other side, and that the edge."""
    pairs = leaf_pairs(store)
    for t in leaves(store).tolist():
        for k in range(3):
            u, j = divmod(int(store.nodes[t, c.NEIGHBOR + k]), 4)
            assert u == across(store, t, k, pairs)
            assert store.nodes[u, c.NEIGHBOR + j] == c.edge(t, k)


def test_a_subdivided_triangle_has_three_children_about_the_site():
    store, others = half_inserted(uniform(60))
    mesh, before = store.mesh(), len(leaves(store))
    for count, q in enumerate(others.tolist()):
        t, _ = locate(mesh, q)
        row = store.nodes[t, :3].tolist()
        first = subdivide(mesh, 0, t, q, 5)
        assert store.nodes[t, c.CHILD] == 2 * first + 1
        assert store.nodes[first : first + 3, :3].tolist() == [
            [q, row[k], row[(k + 1) % 3]] for k in range(3)
        ]
        assert store.nodes[first : first + 3, c.LOCK].tolist() == [5] * 3
        assert store.nodes[first : first + 3, c.CHILD].tolist() == [-1] * 3
        assert len(leaves(store)) == before + 2 * (count + 1)
        assert_neighbours(store)


def test_a_flipped_edge_leads_from_the_vertex_to_the_one_across():
    store, _ = half_inserted(uniform(80))
    mesh, rng, flipped = store.mesh(), np.random.default_rng(0), 0
    for _ in range(40):
        f = int(rng.choice(leaves(store)))
        k = int(rng.integers(3))
        u, j = divmod(int(store.nodes[f, c.NEIGHBOR + k]), 4)
        if store.nodes[f, k] < 0:
            continue
        p, d = int(store.nodes[f, k]), int(store.nodes[u, j])
        a, b = int(store.nodes[f, (k + 1) % 3]), int(store.nodes[f, (k + 2) % 3])
        if p == d or frozenset((p, d)) in leaf_pairs(store):
            continue  # they have an edge already
        first = flip(mesh, 0, f, k, 0)
        flipped += 1
        assert store.nodes[first : first + 2, :3].tolist() == [[p, a, d], [p, d, b]]
        assert store.nodes[[f, u], c.CHILD].tolist() == [2 * first] * 2
        assert_neighbours(store)
    assert flipped > 10
    assert store.state[0, c.FLIPS] >= flipped


@pytest.mark.parametrize("lock", [0, 3])
def test_after_legalisation_it_is_delaunay(lock):
    store, others = half_inserted(uniform(120))
    mesh = store.mesh()
    for q in others.tolist():
        conflicting = [t for t in leaves(store).tolist() if conflicts(store, t, q)]
        flips = store.state[0, c.FLIPS]
        f = insert(mesh, 0, locate(mesh, q)[0], q, lock)
        assert store.nodes[f, 0] == q
        # each conflict goes by the subdivision or by a flip
        assert store.state[0, c.FLIPS] - flips == len(conflicting) - 1
        star = [t for t in leaves(store).tolist() if store.nodes[t, 0] == q]
        assert not any(illegal(mesh, t) for t in star)
        assert (store.nodes[star, c.LOCK] == lock).all()
    assert_delaunay(store)
    assert_neighbours(store)

"""A walk ends in the leaf that the history leads to, wherever it begins."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.dag import locate
from dt3d.threaded2d.flips import insert
from dt3d.threaded2d.location import DAG, WALK, find, find_again, walk_history

from .families import EVERY_SET, uniform
from .runs import half_inserted
from .stepping import conflicts, leaves, orientation


@pytest.mark.parametrize("name", EVERY_SET)
def test_from_any_triangle_to_the_leaf_that_the_history_leads_to(name):
    store, others = half_inserted(EVERY_SET[name](120))
    mesh, present = store.mesh(), set(leaves(store).tolist())
    starts = np.flatnonzero(store.nodes[: store.used, 0] != store.nodes[: store.used, 1])  # those in use
    gone = [t for t in starts.tolist() if t not in present]
    assert gone
    for q in others.tolist():
        want, _ = locate(mesh, q)
        for t in [*gone[::9], *sorted(present)[::7]]:
            found, _ = walk_history(mesh, t, q)
            # a site on an edge is in the triangles on both sides
            assert found in present
            assert found == want or _on_an_edge(store, want, q)
            assert _contains(store, found, q)


def _turns(store, t, q):
    row = store.nodes[t, :3].tolist()
    edges = [(row[k], row[(k + 1) % 3]) for k in range(3)]
    return [orientation(store.points, a, b, q) for a, b in edges if min(a, b) >= 0]


def _contains(store, t, q):
    """Within a triangle or on its border, or beyond the edge of a ghost or on its line."""
    return all(turn >= 0 for turn in _turns(store, t, q))


def _on_an_edge(store, t, q):
    return 0 in _turns(store, t, q)


def test_a_walk_takes_no_step_from_the_leaf_and_one_from_across_an_edge():
    store, others = half_inserted(uniform(200))
    mesh = store.mesh()
    for q in others.tolist():
        t, _ = locate(mesh, q)
        assert walk_history(mesh, t, q) == (t, 0)
        if store.nodes[t, :3].min() >= 0:
            for edge in store.nodes[t, c.NEIGHBOR : c.NEIGHBOR + 3].tolist():
                found, steps = walk_history(mesh, edge // 4, q)
                assert found == t
                assert steps >= 1


def test_sites_are_found_by_either_way_and_again():
    store, others = half_inserted(uniform(200))
    mesh = store.mesh()
    store.state[0, c.HINT] = leaves(store)[5]
    for q in others.tolist():
        t, visited = find(mesh, 0, q, DAG)
        assert conflicts(store, t, q)
        assert visited > 0
        assert find(mesh, 0, q, WALK) == walk_history(mesh, int(leaves(store)[5]), q)
        assert find(mesh, 0, q, WALK)[0] == t
        for location in (DAG, WALK):
            assert find_again(mesh, t, q, location) == (t, 0)


def test_a_leaf_that_is_no_more_leads_to_one_that_contains_the_site():
    points = uniform(200)
    early, others = half_inserted(points)
    late, _ = half_inserted(points)
    mesh, old = late.mesh(), {}
    for q in others.tolist():
        old[q] = locate(early.mesh(), q)[0]
    np.testing.assert_array_equal(early.nodes, late.nodes)
    for count, q in enumerate(others.tolist()):
        for location in (DAG, WALK):
            assert find_again(mesh, old[q], q, location)[0] == locate(mesh, q)[0]
        insert(mesh, 0, locate(mesh, q)[0], q, 0)
        assert len(leaves(late)) == len(leaves(early)) + 2 * (count + 1)

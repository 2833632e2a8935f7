"""Conflict and side with the vertex at infinity, against rational arithmetic and the lexicographic order."""

from fractions import Fraction

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.geometry import in_conflict, root_of, side_of_line
from dt3d.threaded2d.mesh import Store

from . import stepping
from .families import EVERY_SET, uniform
from .runs import half_inserted


def test_in_conflict_are_the_triangles_whose_circle_contains_the_site():
    store, others = half_inserted(uniform(80))
    mesh, found = store.mesh(), 0
    for q in others.tolist():
        for t in stepping.leaves(store).tolist():
            assert in_conflict(mesh, t, q) == stepping.conflicts(store, t, q)
            found += in_conflict(mesh, t, q)
    assert found > len(others)


@pytest.mark.parametrize("q", [2, 3, 4, 5])
def test_a_ghost_conflicts_with_what_lies_between_the_ends_of_its_edge(q):
    points = np.array([[0.0, 0], [4, 4], [1, 1], [3, 3], [5, 5], [-1, -1], [0, 4]])
    store = Store(points, np.array([0, 1, 6]), 1)
    ghost = next(t for t in range(1, 4) if {0, 1} <= set(store.nodes[t, :3].tolist()))
    assert in_conflict(store.mesh(), ghost, q) == (q in (2, 3))


@pytest.mark.parametrize("name", EVERY_SET)
def test_sides_of_lines_and_of_rays(name):
    store, others = half_inserted(EVERY_SET[name](60))
    mesh, points = store.mesh(), store.points
    s = store.nodes[0, :3].tolist()
    for q in others.tolist():
        for p in {*s, *others.tolist()[:5]} - {q}:
            for v in s:
                if v != p:
                    assert side_of_line(mesh, p, v, q) == _sign(stepping.orientation(points, p, v, q))
            # a ray leads from the centre, which is near s0, then in the direction of s1, then of s2
            turns = [_sign(stepping.orientation(points, u, p, q)) for u in s if u != p]
            assert side_of_line(mesh, p, c.INFINITE, q) == next((t for t in turns if t), 0)


def _sign(x: Fraction) -> int:
    return (x > 0) - (x < 0)


@pytest.mark.parametrize("name", EVERY_SET)
def test_the_first_triangle_and_the_ghosts_around_it_share_the_plane(name):
    store, others = half_inserted(EVERY_SET[name](60))
    mesh, seen = store.mesh(), set()
    s0, s1, s2 = store.nodes[0, :3].tolist()
    for q in others.tolist():
        root = root_of(mesh, q)
        seen.add(root)
        turns = [stepping.orientation(store.points, a, b, q) for a, b in ((s0, s1), (s1, s2), (s2, s0))]
        if root == 0:
            assert min(turns) >= 0
        else:
            ghost = store.nodes[root, :3].tolist()
            k = ghost.index(c.INFINITE)
            assert stepping.orientation(store.points, ghost[(k + 1) % 3], ghost[(k + 2) % 3], q) > 0
    assert len(seen) > 1

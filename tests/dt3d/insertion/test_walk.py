"""Walks end in the tetrahedron that contains a site, wherever they begin, or where a thread may not go."""

import numpy as np
import pytest

from dt3d.insertion.mesh import INFINITE, bundle, neighbors, set_tetrahedron_of, vertices
from dt3d.insertion.ownership import Part, owns
from dt3d.insertion.store import Store
from dt3d.insertion.walk import NEARBY, locate, nearby_start, walk
from dt3d.predicates import work_array

from ..exact import integers, orient
from ..families import grid
from .growing import grown, is_ghost, living, rows_of, site

SLACK = 2.0**-1000


def assert_contains(points, mesh, t, v):
    """The site is on no outer side of the tetrahedron, or beyond the facet of the ghost."""
    corners = vertices(mesh)[t].tolist()
    for k in range(4):
        if INFINITE not in corners or corners[k] == INFINITE:
            replaced = [points[v if i == k else w] for i, w in enumerate(corners)]
            assert orient(*replaced) >= (1 if INFINITE in corners else 0)


@pytest.mark.parametrize("kind", ["random", "grid"])
def test_from_anywhere_to_the_site(kind):
    rng = np.random.default_rng(0)
    points = rng.random((60, 3)) if kind == "random" else rng.permutation(grid(4)) / 4
    points[-4:] = [[2, 2, 2], [0.5, 0.5, 0.5], [-1, 0.3, 0.3], [0.3, 0.2, 3]]
    team, exact, w = grown(points, len(points) - 8), integers(points), work_array(points)
    for v in range(len(points) - 8, len(points)):
        for start in living(team)[::5]:
            assert_contains(exact, team.store.mesh, locate(team.store.mesh, start, v, SLACK, w), v)


def test_a_thread_reads_only_what_has_a_vertex_of_its_own():
    points = np.random.default_rng(1).random((200, 3))
    points = points[np.argsort(points[:, 0])]  # so that a part is a slab
    team, w = grown(np.roll(points, 20, axis=0), 200), work_array(points)
    points, mesh, part = np.roll(points, 20, axis=0), team.store.mesh, Part(60, 50, 200)
    ended = {True: 0, False: 0}
    for start in living(team)[::3]:
        for v in range(0, 200, 9):
            t, found, steps = walk(mesh, start, site(points, v), part, SLACK, w)
            ended[found] += 1
            assert steps >= 0
            assert found or steps == 0 or owns_one_vertex(mesh, t, part)
            if found:
                assert v in vertices(mesh)[t] or is_ghost(mesh, t)
    assert min(ended.values()) > 100


def owns_one_vertex(mesh, t, part):
    return any(owns(part, v) for v in vertices(mesh)[t].tolist() if v != INFINITE)


def test_a_walk_in_circles_is_longer_than_there_are_slots():
    points = np.concatenate([np.eye(3), [[0, 0, 0], [3, 3, 3]]]).astype(float)
    store = Store(rows_of(points), np.array([3, 0, 1, 2], np.int32), 50, 8)
    arguments = store.mesh, 0, 4, SLACK, work_array(points)
    assert locate(*arguments) == 1  # the ghost opposite the first vertex
    t, k = np.divmod(np.arange(200), 4)
    finite = (vertices(store.mesh) < INFINITE - 1).all(axis=1)
    neighbors(store.mesh)[finite] = (4 * t + (k + 1) % 4).reshape(-1, 4)[finite]
    assert locate(*arguments) == -1


def test_a_stopped_walk_begins_again_at_the_nearest_site_that_knows_a_tetrahedron():
    mesh = bundle(np.zeros(400), np.zeros(8, np.uint32), np.zeros(4))
    whole = Part(0, 100, 100)
    assert nearby_start(mesh, 50, whole) == -1
    set_tetrahedron_of(mesh, 50 + NEARBY + 1, 5)
    assert nearby_start(mesh, 50, whole) == -1
    set_tetrahedron_of(mesh, 58, 7)
    set_tetrahedron_of(mesh, 44, 9)
    assert nearby_start(mesh, 50, whole) == 9
    assert nearby_start(mesh, 50, Part(50, 40, 100)) == 7
    set_tetrahedron_of(mesh, 99, 11)
    assert nearby_start(mesh, 0, whole) == -1  # the curve is no circle

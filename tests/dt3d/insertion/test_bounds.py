"""Walks, searches and growth that do not end in a broken triangulation: each ends in an `InternalError`.

No input leads there, so the tests break the triangulation on purpose, between two calls of the compiled code.
"""

import threading

import numpy as np
import pytest

import dt3d
from dt3d.insertion import crew, kernel, loop, spheres, star, walk
from dt3d.insertion.layout import DEAD
from dt3d.insertion.store import Store
from dt3d.predicates import work_array

from ..families import grid

POINTS = np.random.default_rng(0).random((600, 3))


@pytest.fixture
def broken(monkeypatch):
    """``broken(damage)`` calls ``damage(arguments)`` before every stretch of 50 sites but the first ones."""
    monkeypatch.setattr(crew, "STRETCH", 50)
    real = crew.insert

    def begin(damage, calls=3):
        made = []

        def insert(*arguments):
            made.append(0)
            if len(made) > calls:
                damage(*arguments)
            return real(*arguments)

        monkeypatch.setattr(crew, "insert", insert)

    return begin


def in_circles(points, rows, labels, mesh, *_):
    """Beyond each facet of a tetrahedron lies the tetrahedron itself, entered through another facet."""
    t, k = np.divmod(np.arange(len(mesh) // 2), 4)
    finite = (mesh.reshape(-1, 8)[:, :4] < DEAD).all(axis=1)
    mesh.reshape(-1, 8)[finite, 4:] = (4 * t + (k + 1) % 4).reshape(-1, 4)[finite]


def all_in_conflict(points, rows, labels, mesh, spheres, radii, *_):
    spheres.reshape(-1, 4)[:, :3] = 9  # the centres; where there is no sphere they were never written
    radii.reshape(-1, 8)[:, 6:] = np.inf


def none_in_conflict(points, rows, labels, mesh, spheres, radii, *_):
    spheres.reshape(-1, 4)[:, :3] = 9
    radii.reshape(-1, 8)[:, 6:] = -1, 0


def test_a_walk_in_circles_ends(broken):
    broken(in_circles)
    with pytest.raises(dt3d.InternalError, match="a walk to a site visits more tetrahedra than there are"):
        dt3d.Delaunay(POINTS, threads=1)


def test_a_walk_in_circles_of_one_thread_ends_all(broken, monkeypatch):
    monkeypatch.setattr(loop, "available_cores", lambda: 4)
    monkeypatch.setattr(crew, "LEAST_PIECE", 50)
    broken(in_circles, calls=6)
    with pytest.raises(dt3d.InternalError, match="please report"):
        dt3d.Delaunay(POINTS, threads=4)
    assert threading.active_count() == 1


def test_a_walk_takes_fewer_steps_than_there_are_slots():
    points = np.concatenate([np.eye(3), [[0, 0, 0], [3, 3, 3]]]).astype(float)
    rows = np.concatenate([points, np.zeros((5, 1))], axis=1).ravel()
    store = Store(np.array([3, 0, 1, 2], np.int32), 50, 8)
    arguments = rows, store.mesh, 0, 4, 2.0**-1000, work_array(points)
    beyond = walk.locate(points, *arguments)
    assert beyond == 1  # the ghost opposite the first vertex
    in_circles(None, None, None, store.mesh)
    assert walk.locate(points, *arguments) == -1


def test_a_lost_walk_to_where_a_thread_begins(monkeypatch):
    monkeypatch.setattr(loop, "available_cores", lambda: 2)
    monkeypatch.setattr(crew, "LEAST_PIECE", 20)
    monkeypatch.setattr(crew, "locate", lambda *arguments: -1)
    with pytest.raises(dt3d.InternalError, match="a walk to a site"):
        dt3d.Delaunay(POINTS, threads=2)
    assert threading.active_count() == 1


@pytest.mark.parametrize("threads", [1, 2])
def test_a_copy_that_was_missed_is_not_inserted_without_a_word(threads, monkeypatch):
    monkeypatch.setattr(loop, "available_cores", lambda: 2)
    monkeypatch.setattr(crew, "LEAST_PIECE", 20)
    monkeypatch.setattr(loop, "copied", lambda *arguments: False)
    for points in (POINTS, grid(6), np.ldexp(POINTS, -900)):
        with pytest.raises(dt3d.InternalError, match="a site is where another one is already"):
            dt3d.Delaunay(np.concatenate([points, points[100:101]]), threads=threads)
    assert threading.active_count() == 1


def test_a_cavity_of_all_tetrahedra_has_no_rim(broken):
    broken(all_in_conflict)
    with pytest.raises(dt3d.InternalError, match="facets around a cavity do not close to a sphere"):
        dt3d.Delaunay(POINTS, threads=1)


def test_a_site_on_a_facet_makes_no_flat_tetrahedron(broken):
    broken(none_in_conflict, calls=0)
    with pytest.raises(dt3d.InternalError, match="a tetrahedron that is flat or turned"):
        dt3d.Delaunay(grid(6), threads=1)


@pytest.mark.parametrize("scale", [1.0, 2.0**-80])
@pytest.mark.parametrize(("corner", "is_flat"), [(1.0, False), (0.0, True), (-1.0, True)])
def test_every_tetrahedron_of_a_star_is_proved_positive(scale, corner, is_flat):
    """By its sphere, or by exact arithmetic: on the small scale, where there are no spheres, for all."""
    points = scale * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, corner]])
    near = np.array([0xFFFFFFFF, 1, 2, 3], np.uint32)
    relative = np.full((4, 4), np.nan)
    relative[:3, 1:] = points[1:].T
    relative[3, 1:] = (points[1:] ** 2).sum(axis=1)
    facet, slots = np.array([[1], [2], [3]], np.uint32), np.zeros(1, np.uint32)
    sphere = np.zeros(4)
    radii = sphere.view(np.float32)
    unproved = spheres.round_spheres(*relative, *facet, slots, 1, *points[0], 1.0, sphere, radii)
    assert unproved == (is_flat or scale < 1)
    assert spheres.flat(points, radii, 0, *facet, near, slots, 1, work_array(points)) == is_flat
    # beyond a hull facet lies a ghost, which is not flat
    facet[2] = 0
    assert spheres.round_spheres(*relative, *facet, slots, 1, *points[0], 1.0, sphere, radii) == 1
    assert not spheres.flat(points, radii, 0, *facet, near, slots, 1, work_array(points))


def test_vertices_that_no_sphere_has():
    """Facets that share no vertex are no rim; their vertices would not have room."""
    rim = np.arange(12, dtype=np.uint32).reshape(3, 4)
    near, at, rel = np.zeros(6, np.uint32), np.zeros(6, np.uint32), np.zeros((4, 6))
    near[0] = 0xFFFFFFFF
    rows = np.zeros(48)
    labels = rows.view(np.uint32)
    assert star.number_vertices.py_func(rows, labels, 0.0, 0.0, 0.0, rim, 4, near, rel, at) == 0


def test_edges_of_a_torn_star_are_searched_in_vain():
    facets = np.array([[1, 2, 3], [1, 3, 4], [1, 4, 2], [2, 4, 3]], np.uint32).T
    mesh, slots = np.zeros(64, np.uint32), np.arange(4, dtype=np.uint32)
    keys, values = np.empty(64, np.int64), np.empty(64, np.uint32)
    assert star.link_wide(mesh, *facets, slots, 4, keys, values)
    assert not star.link_wide(mesh, *facets, slots, 3, keys, values)
    edges = np.zeros(1 << 2 * star.NARROW, np.uint32)
    assert not star.link_narrow(mesh, *facets, slots, 3, edges)
    assert star.link_narrow(mesh, *facets, slots, 4, edges)


def test_a_thread_that_is_alone_does_not_defer(broken):
    def defer(*arguments):
        arguments[7][kernel.DEFERRED] = 5

    broken(defer)
    with pytest.raises(dt3d.InternalError, match="a thread that is alone defers 5 sites"):
        dt3d.Delaunay(POINTS, threads=1)


@pytest.mark.parametrize(
    ("short", "message"),
    [
        (kernel.NEEDS_SCRATCH, "a cavity has more facets than the"),
        (kernel.NEEDS_SLOTS, "are no room for one more site of 600"),
    ],
)
def test_growth_without_progress_ends(short, message, monkeypatch):
    monkeypatch.setattr(crew, "insert", lambda *arguments: short)
    with pytest.raises(dt3d.InternalError, match=message):
        dt3d.Delaunay(POINTS, threads=1)


def test_a_star_of_all_sites_is_no_growth_without_progress(monkeypatch):
    """All sites are neighbours of the last, with as little memory to begin with as possible."""
    monkeypatch.setattr(loop, "SLOTS_PER_SITE", 0)
    monkeypatch.setattr(loop, "LARGEST_BLOCK", 8)
    monkeypatch.setattr(crew, "STRETCH", 1)
    sphere = np.random.default_rng(1).standard_normal((2000, 3))
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    assert dt3d.Delaunay(np.concatenate([sphere, np.zeros((1, 3))]), threads=1).verify()

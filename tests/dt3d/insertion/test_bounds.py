"""Walks, searches and growth that do not end in a broken triangulation: each ends in an `InternalError`.

No input leads there, so the tests break the triangulation on purpose, between two calls of the compiled code.
"""

import threading

import numpy as np
import pytest

import dt3d
from dt3d.insertion import driver, insert, spheres, star, team, walk
from dt3d.insertion.mesh import FREE, bundle, neighbors, site_at_hand, squared_radii, vertices
from dt3d.insertion.store import Store
from dt3d.insertion.worker import State, scratch_for
from dt3d.predicates import work_array

from ..families import grid


def rows_of(points):
    return np.concatenate([points, np.zeros((len(points), 1))], axis=1).ravel()


POINTS = np.random.default_rng(0).random((600, 3))


@pytest.fixture
def broken(monkeypatch):
    """``broken(damage)`` calls ``damage(arguments)`` before every stretch of 50 sites but the first ones."""
    monkeypatch.setattr(team, "SITES_PER_CALL", 50)
    real = team.insert

    def begin(damage, calls=3):
        made = []

        def insert(*arguments):
            made.append(0)
            if len(made) > calls:
                damage(*arguments)
            return real(*arguments)

        monkeypatch.setattr(team, "insert", insert)

    return begin


def in_circles(mesh, *_):
    """Beyond each facet of a tetrahedron lies the tetrahedron itself, entered through another facet."""
    t, k = np.divmod(np.arange(vertices(mesh).size), 4)
    finite = (vertices(mesh) < FREE).all(axis=1)
    neighbors(mesh)[finite] = (4 * t + (k + 1) % 4).reshape(-1, 4)[finite]


def all_in_conflict(mesh, *_):
    mesh.spheres.reshape(-1, 4)[:, :3] = 9  # the centres; where there is no sphere they were never written
    squared_radii(mesh)[:] = np.inf


def none_in_conflict(mesh, *_):
    mesh.spheres.reshape(-1, 4)[:, :3] = 9
    squared_radii(mesh)[:] = -1, 0


def test_a_walk_in_circles_ends(broken):
    broken(in_circles)
    with pytest.raises(dt3d.InternalError, match="a walk to a site visits more tetrahedra than there are"):
        dt3d.Delaunay(POINTS, threads=1)


def test_a_walk_in_circles_of_one_thread_ends_all(broken, monkeypatch):
    monkeypatch.setattr(driver, "available_cores", lambda: 4)
    monkeypatch.setattr(team, "LEAST_SITES_PER_THREAD", 50)
    broken(in_circles, calls=6)
    with pytest.raises(dt3d.InternalError, match="please report"):
        dt3d.Delaunay(POINTS, threads=4)
    assert threading.active_count() == 1


def test_a_walk_takes_fewer_steps_than_there_are_slots():
    points = np.concatenate([np.eye(3), [[0, 0, 0], [3, 3, 3]]]).astype(float)
    store = Store(rows_of(points), np.array([3, 0, 1, 2], np.int32), 50, 8)
    arguments = store.mesh, 0, 4, 2.0**-1000, work_array(points)
    assert walk.locate(*arguments) == 1  # the ghost opposite the first vertex
    in_circles(store.mesh)
    assert walk.locate(*arguments) == -1


def test_a_lost_walk_to_where_a_thread_begins(monkeypatch):
    monkeypatch.setattr(driver, "available_cores", lambda: 2)
    monkeypatch.setattr(team, "LEAST_SITES_PER_THREAD", 20)
    monkeypatch.setattr(team, "locate", lambda *arguments: -1)
    with pytest.raises(dt3d.InternalError, match="a walk to a site"):
        dt3d.Delaunay(POINTS, threads=2)
    assert threading.active_count() == 1


@pytest.mark.parametrize("threads", [1, 2])
def test_a_copy_that_was_missed_is_not_inserted_without_a_word(threads, monkeypatch):
    monkeypatch.setattr(driver, "available_cores", lambda: 2)
    monkeypatch.setattr(team, "LEAST_SITES_PER_THREAD", 20)
    monkeypatch.setattr(driver, "copied", lambda *arguments: False)
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
    mesh = bundle(rows_of(points), np.zeros(8, np.uint32), np.zeros(4))
    scratch, site, w = scratch_for(4), site_at_hand(mesh, 0), work_array(points)
    scratch.vertices[1:] = 1, 2, 3
    scratch.x[1:], scratch.y[1:], scratch.z[1:] = points[1:].T
    scratch.squared[1:] = (points[1:] ** 2).sum(axis=1)
    scratch.rim[:, 0], scratch.slots[0] = (1, 2, 3), 0
    assert spheres.round_spheres(mesh, site, scratch, 1, 1.0) == (is_flat or scale < 1)
    assert spheres.flat(mesh, 0, scratch, 1, w) == is_flat
    # beyond a hull facet lies a ghost, which is not flat
    scratch.rim[2, 0] = 0
    assert spheres.round_spheres(mesh, site, scratch, 1, 1.0) == 1
    assert not spheres.flat(mesh, 0, scratch, 1, w)


def test_vertices_that_no_sphere_has():
    """Facets that share no vertex are no rim; their vertices would not have room."""
    mesh = bundle(np.zeros(48), np.zeros(8, np.uint32), np.zeros(4))
    scratch = scratch_for(6)
    scratch.rim[:, :4] = np.arange(12).reshape(3, 4)
    assert star.number_vertices(mesh, site_at_hand(mesh, 0), scratch, 4) == 0


def test_edges_of_a_torn_star_are_searched_in_vain():
    mesh = bundle(np.zeros(8), np.zeros(64, np.uint32), np.zeros(32))
    scratch = scratch_for(4)
    scratch.rim[:] = np.array([[1, 2, 3], [1, 3, 4], [1, 4, 2], [2, 4, 3]]).T
    scratch.slots[:], scratch.edges[:] = np.arange(4), 0
    for link, facets, closed in (
        (star.link_wide, 4, True),
        (star.link_wide, 3, False),
        (star.link_narrow, 3, False),
        (star.link_narrow, 4, True),
    ):
        assert link(mesh, scratch, facets) == closed


def test_a_thread_that_is_alone_does_not_defer(broken):
    def defer(*arguments):
        arguments[2][State.DEFERRED] = 5

    broken(defer)
    with pytest.raises(dt3d.InternalError, match="a thread that is alone defers 5 sites"):
        dt3d.Delaunay(POINTS, threads=1)


@pytest.mark.parametrize(
    ("short", "message"),
    [
        (insert.NEEDS_SCRATCH, "a cavity has more facets than the"),
        (insert.NEEDS_SLOTS, "are no room for one more site of 600"),
    ],
)
def test_growth_without_progress_ends(short, message, monkeypatch):
    monkeypatch.setattr(team, "insert", lambda *arguments: short)
    with pytest.raises(dt3d.InternalError, match=message):
        dt3d.Delaunay(POINTS, threads=1)


def test_a_star_of_all_sites_is_no_growth_without_progress(monkeypatch):
    """All sites are neighbours of the last, with as little memory to begin with as possible."""
    monkeypatch.setattr(driver, "SLOTS_PER_SITE", 0)
    monkeypatch.setattr(driver, "LARGEST_BLOCK", 8)
    monkeypatch.setattr(team, "SITES_PER_CALL", 1)
    sphere = np.random.default_rng(1).standard_normal((2000, 3))
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    assert dt3d.Delaunay(np.concatenate([sphere, np.zeros((1, 3))]), threads=1).verify()

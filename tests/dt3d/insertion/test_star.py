"""The star of a site: numbers of vertices, slots, and links, in the two ways that there are."""

import numpy as np
import pytest

from dt3d.insertion import star
from dt3d.insertion.cavity import search
from dt3d.insertion.mesh import FREE, bundle, free_slot, neighbors, site_at_hand, tetrahedron_of, vertices
from dt3d.insertion.ownership import Part
from dt3d.insertion.walk import locate
from dt3d.insertion.worker import FreeSlots, scratch_for
from dt3d.predicates import work_array

from .growing import check_links, grown, site

POINTS = np.random.default_rng(0).random((60, 3))
NEW = len(POINTS) - 1
POINTS[NEW] = 0.5  # within the hull


@pytest.fixture
def opened():
    """A team, scratch memory with the cavity of the last site and numbered vertices, and the counts."""
    team = grown(POINTS, NEW)
    mesh, w, scratch = team.store.mesh, work_array(POINTS), scratch_for(1000)
    s = site(POINTS, NEW)
    start = locate(mesh, 0, NEW, 2.0**-1000, w)
    size, facets, _ = search(mesh, start, s, Part(0, len(POINTS), len(POINTS)), scratch, w)
    rim = scratch.rim[:, :facets].copy()
    count = star.number_vertices(mesh, s, scratch, facets)
    return team, scratch, rim, size, facets, count


def test_vertices_are_numbered(opened):
    _, scratch, rim, _, facets, count = opened
    assert facets == 2 * (count - 1) - 4  # none of them is the infinite one
    assert set(scratch.vertices[1:count].tolist()) == set(rim.ravel().tolist())
    np.testing.assert_array_equal(scratch.vertices[scratch.rim[:, :facets]], rim)
    relative = POINTS[scratch.vertices[1:count]] - POINTS[NEW]
    np.testing.assert_array_equal(np.transpose([scratch.x, scratch.y, scratch.z])[1:count], relative)
    for i in range(1, count):
        assert i in scratch.rim[:, scratch.facet_of[i]]


def test_slots_of_the_cavity_come_first_then_free_ones_then_fresh_ones(opened):
    team, scratch, rim, size, facets, count = opened
    mesh, begin = team.store.mesh, team.store.used + 100
    free_slot(mesh, begin, 3)
    left = star.make_tetrahedra(mesh, NEW, scratch, size, facets, FreeSlots(begin, 1, begin + 1, begin + 40))
    assert left == (3, 0, begin + facets - size, begin + 40)
    slots = [*scratch.cavity[:size], *range(begin, begin + facets - size)]
    assert scratch.slots[:facets].tolist() == slots
    np.testing.assert_array_equal(vertices(mesh)[slots], np.concatenate([[[NEW] * facets], rim]).T)
    np.testing.assert_array_equal(neighbors(mesh)[slots, 0], scratch.outer[:facets])
    star.note_tetrahedra(mesh, NEW, scratch, count)
    for v in (NEW, *scratch.vertices[1:count].tolist()):
        assert v in vertices(mesh)[tetrahedron_of(mesh, v)]


def test_what_a_large_cavity_leaves_is_free():
    mesh, scratch = bundle(np.zeros(8), np.zeros(80, np.uint32), np.zeros(40)), scratch_for(8)
    scratch.cavity[:], scratch.outer[:], scratch.rim[:] = np.arange(8), 36, 0
    left = star.make_tetrahedra(mesh, 1, scratch, 5, 3, FreeSlots(9, 1, 0, 0))
    assert left == (4, 3, 0, 0)
    assert vertices(mesh)[3:5, 0].tolist() == [FREE, FREE]
    assert neighbors(mesh)[3:5, 0].tolist() == [9, 3]


def test_both_ways_to_link_find_the_same_neighbors(opened):
    team, scratch, _, size, facets, count = opened
    mesh, begin = team.store.mesh, team.store.used + 100
    star.make_tetrahedra(mesh, NEW, scratch, size, facets, FreeSlots(0, 0, begin, begin + 40))
    slots = scratch.slots[:facets]
    assert star.link(mesh, scratch, facets, count, team.workers[0].work)
    narrow = neighbors(mesh)[slots].copy()
    neighbors(mesh)[slots, 1:] = 0
    assert star.link_wide(mesh, scratch, facets)
    np.testing.assert_array_equal(neighbors(mesh)[slots], narrow)
    for t in slots:
        for k in range(4):
            u, j = divmod(int(narrow[slots == t, k][0]), 4)
            assert neighbors(mesh)[u, j] == 4 * t + k


def test_links_of_a_whole_triangulation():
    check_links(grown(POINTS, len(POINTS)))


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

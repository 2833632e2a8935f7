"""The layout of records: what accessors write they read, and views for Python agree with them."""

import numpy as np
import pytest

from dt3d.insertion import mesh as m

from ..exact import orient
from .growing import check_links, grown, living, rows_of

POINTS = np.random.default_rng(0).random((40, 3))


@pytest.fixture
def mesh():
    rng = np.random.default_rng(1)
    tetrahedra = rng.integers(0, 2**32 - 2, 40, dtype=np.uint32)
    return m.bundle(rows_of(POINTS), tetrahedra, rng.random(20))


def test_facets_have_a_tetrahedron_and_a_side():
    for t in range(3):
        for k in range(4):
            f = m.facet(t, k)
            assert (m.tetrahedron(f), m.side(f)) == (t, k)


def test_vertices_and_neighbors(mesh):
    for t in range(5):
        for k in range(4):
            assert m.vertex(mesh, t, k) == m.vertices(mesh)[t, k]
            assert m.neighbor(mesh, t, k) == m.neighbors(mesh)[t, k]
    before = mesh.tetrahedra.copy()
    m.set_vertex(mesh, 2, 3, 77)
    m.set_neighbor(mesh, 3, 1, 88)
    assert (m.vertices(mesh)[2, 3], m.neighbors(mesh)[3, 1]) == (77, 88)
    assert (mesh.tetrahedra != before).sum() == 2


def test_free_slots_are_a_list(mesh):
    m.free_slot(mesh, 4, 1)
    assert m.next_free(mesh, 4) == 1
    assert not m.is_finite(mesh, 4)


def test_ghosts_are_not_finite(mesh):
    assert m.is_finite(mesh, 1)
    m.set_vertex(mesh, 1, 2, m.INFINITE)
    assert not m.is_finite(mesh, 1)


def test_spheres_and_marks(mesh):
    m.set_center(mesh, 1, 1.0, 2.0, 3.0)
    m.set_radius(mesh, 1, 4.0, 5.0)
    assert m.squared_distance(mesh, 1, m.Site(0, 1.0, 2.0, 5.0)) == 4
    assert (m.radius_below(mesh, 1), m.radius_above(mesh, 1)) == (4, 5)
    np.testing.assert_array_equal(m.squared_radii(mesh)[1], [4, 5])
    m.mark(mesh, 1)
    assert (m.radius_below(mesh, 1), m.radius_above(mesh, 1)) == (4, -5)
    for _ in range(2):
        m.unmark(mesh, 1)
        assert m.radius_above(mesh, 1) == 5


def test_sites(mesh):
    assert m.site_at_hand(mesh, 7) == (7, *POINTS[7])
    assert m.offset(mesh, 8, m.site_at_hand(mesh, 7)) == tuple(POINTS[8] - POINTS[7])
    assert m.tetrahedron_of(mesh, 7) == -1
    m.set_tetrahedron_of(mesh, 7, 0)
    m.set_label(mesh, 7, 3)
    assert (m.tetrahedron_of(mesh, 7), m.label(mesh, 7)) == (0, 3)
    np.testing.assert_array_equal(mesh.points, POINTS)  # the words beside coordinates are none


def test_facets_by_the_four_group_turn_to_their_vertex():
    """The k-th vertex sees the vertices k^1, k^2, k^3 in the order in which v0 sees v1, v2, v3."""
    corners = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    for k in range(4):
        assert orient(*corners[[k, k ^ 1, k ^ 2, k ^ 3]]) == orient(*corners) == 1


def test_a_growing_triangulation_has_this_layout():
    team = grown(POINTS, 30)
    check_links(team)
    mesh = team.store.mesh
    for v in range(30):
        assert v in m.vertices(mesh)[m.tetrahedron_of(mesh, v)]
    finite = [t for t in living(team) if m.is_finite(mesh, t)]
    corners = POINTS[m.vertices(mesh)[finite]]
    assert (orient(*(corners[:, k] for k in range(4))) > 0).all()


@pytest.mark.parametrize("n", [1, 3, 1000])
def test_arrays_begin_at_a_line_of_the_cache(n):
    array = m.aligned(n, np.float64)
    assert (len(array), array.dtype) == (n, np.float64)
    assert array.ctypes.data % m.CACHE_LINE == 0

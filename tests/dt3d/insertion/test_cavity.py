"""The cavity is what a site destroys, by the definition."""

import numpy as np
import pytest

from dt3d.insertion import cavity
from dt3d.insertion.cavity import NO_ROOM, NOT_OWNED, conflicts, search, unmark_cavity
from dt3d.insertion.mesh import mark, neighbors, squared_radii, vertices
from dt3d.insertion.ownership import Part, owns_all
from dt3d.insertion.walk import locate
from dt3d.insertion.worker import scratch_for
from dt3d.predicates import work_array

from ..exact import in_sphere, integers, orient
from .growing import grown, is_ghost, living, site

RNG = np.random.default_rng(0)
POINTS = np.concatenate([RNG.random((80, 3)), [[2, 2, 2], [-1, 0.4, 0.4]]])
LEFT_OUT = 8  # the last ones, two of them beyond the hull


@pytest.fixture(scope="module")
def team():
    return grown(POINTS, len(POINTS) - LEFT_OUT)


def destroyed(exact, mesh, t, v):
    """Whether a site is inside the sphere of t, or beyond the facet of a ghost; there are no ties here."""
    corners = vertices(mesh)[t].tolist()
    if not is_ghost(mesh, t):
        return in_sphere(*(exact[u] for u in corners), exact[v]) > 0
    return orient(*(exact[v if u >= len(exact) else u] for u in corners)) > 0


@pytest.mark.parametrize("v", range(len(POINTS) - LEFT_OUT, len(POINTS)))
def test_it_is_all_tetrahedra_that_the_site_destroys(team, v):
    mesh, w, exact = team.store.mesh, work_array(POINTS), integers(POINTS)
    scratch, whole = scratch_for(1000), Part(0, len(POINTS), len(POINTS))
    want = {int(t) for t in living(team) if destroyed(exact, mesh, t, v)}
    assert {int(t) for t in living(team) if conflicts(mesh, t, v, w)} == want
    start = locate(mesh, 0, v, 2.0**-1000, w)
    size, facets, tested = search(mesh, start, site(POINTS, v), whole, scratch, w)
    assert set(scratch.cavity[:size].tolist()) == want
    assert len(want) == size <= tested + 1
    # the facets around, from within
    rim = {}
    for f in range(facets):
        u, k = divmod(int(scratch.outer[f]), 4)
        t = neighbors(mesh)[u, k] // 4
        assert t in want
        assert u not in want
        rim[t, u] = set(scratch.rim[:, f].tolist())
        assert rim[t, u] == set(vertices(mesh)[t].tolist()) & set(vertices(mesh)[u].tolist())
    assert len(rim) == facets
    # the marks
    slots = living(team)
    assert set(slots[squared_radii(mesh)[slots, 1] < 0].tolist()) == want
    unmark_cavity(mesh, scratch.cavity, size)
    assert (squared_radii(mesh)[slots, 1] >= 0).all()


def test_it_stops_at_what_others_own_and_where_there_is_no_room(team):
    mesh, w, v = team.store.mesh, work_array(POINTS), len(POINTS) - 1
    start = locate(mesh, 0, v, 2.0**-1000, w)
    whole, one = Part(0, len(POINTS), len(POINTS)), Part(0, 1, len(POINTS))
    for part, room, result in ((one, 1000, NOT_OWNED), (whole, 6, NO_ROOM)):
        scratch = scratch_for(room)
        size, facets, _ = search(mesh, start, site(POINTS, v), part, scratch, w)
        assert facets == result
        unmark_cavity(mesh, scratch.cavity, size)
        assert (squared_radii(mesh)[living(team), 1] >= 0).all()


def test_what_a_thread_does_not_own_is_not_marked_even_for_a_moment(team, monkeypatch):
    # another thread that looks at a tetrahedron meanwhile takes it for one of its own cavity
    mesh, w, marked = team.store.mesh, work_array(POINTS), []
    monkeypatch.setattr(cavity, "mark", lambda mesh, t: marked.append(int(t)) or mark(mesh, t))
    stopped = 0
    for first in range(0, len(POINTS), 5):
        part = Part(first, 30, len(POINTS))
        for v in range(len(POINTS) - LEFT_OUT, len(POINTS)):
            scratch = scratch_for(1000)
            start = locate(mesh, 0, v, 2.0**-1000, w)
            size, facets, _ = search.py_func(mesh, start, site(POINTS, v), part, scratch, w)
            stopped += facets == NOT_OWNED
            assert all(owns_all(mesh, t, part) for t in marked)
            assert marked == scratch.cavity[:size].tolist()
            unmark_cavity(mesh, scratch.cavity, size)
            marked.clear()
    assert stopped > 10

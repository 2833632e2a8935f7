"""Where walks to single sites begin: near them, or nowhere; always at a tetrahedron that is there."""

import numpy as np
import pytest

from dt3d.insertion import hints
from dt3d.insertion.growing import Growing
from dt3d.insertion.hints import Hints
from dt3d.insertion.mesh import vertices
from dt3d.insertion.worker import State

RNG = np.random.default_rng(3)


def store_of(sites):
    return Growing(sites)._run.store


def test_a_hint_is_a_tetrahedron_near_the_place():
    sites = RNG.random((5000, 3))
    store = store_of(sites)
    table = Hints(store)
    far, unknown = 0.0, 0
    for place in RNG.random((200, 3)):
        t = table.near(table.cell(*place.tolist()))
        if t < 0:  # there is no site in the cell
            unknown += 1
            continue
        corners = vertices(store.mesh)[t].astype(np.int64)
        corners = corners[corners < len(sites)]
        distance = np.linalg.norm(store.mesh.points[corners] - place, axis=1).min()
        far = max(far, distance)
    assert unknown < 12
    assert far < 3.5 * table._side**-1  # within a cell's diagonal and a tetrahedron


@pytest.mark.parametrize(
    "place", [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (-1e300, 1e300, 0.5), (0.5, np.nextafter(1, 2), -0.0)]
)
def test_places_anywhere_have_a_cell(place):
    table = Hints(store_of(RNG.random((50, 3))))
    assert 0 <= table.cell(*place) < table._side**3


def test_flat_and_tiny_boxes_have_cells():
    flat = RNG.random((50, 3)) * [1, 1, 1e-310]
    for sites in (flat, RNG.random((50, 3)) * 1e-310):
        table = Hints(store_of(sites))
        assert table.near(table.cell(*sites[3].tolist())) >= 0


def test_the_table_is_made_again_when_there_are_many_more_sites(monkeypatch):
    monkeypatch.setattr(hints, "LARGEST_PART", 2)
    growing = Growing(RNG.random((40, 3)))
    growing.add(RNG.random((1, 3)))
    assert growing._hints.made_for == 40
    growing.add(RNG.random((100, 3)))
    growing.add(RNG.random((1, 3)))
    assert growing._hints.made_for == 141


def test_walks_of_single_sites_are_short():
    growing = Growing(RNG.random((20_000, 3)))
    state = growing._run.team.workers[0].state
    before = int(state[State.WALKED])
    for site in RNG.random((300, 1, 3)):
        growing.add(site)
    assert int(state[State.WALKED]) - before < 300 * 12

"""Where walks to single sites begin: near them, or nowhere; always at a tetrahedron that is there."""

import numpy as np
import pytest

from dt3d.insertion import hints
from dt3d.insertion.growing import Growing
from dt3d.insertion.hints import Hints
from dt3d.insertion.worker import State

RNG = np.random.default_rng(3)


def store_of(sites):
    return Growing(sites)._run.store


def test_a_hint_is_a_site_near_the_place():
    sites = RNG.random((5000, 3))
    store = store_of(sites)
    table = Hints(store)
    places = RNG.random((200, 3))
    cells = table.cells(places)
    assert cells.tolist() == [table.cell(*place.tolist()) for place in places]
    near = table.near(cells)
    assert near.tolist() == [table.near_one(int(cell)) for cell in cells]
    known = near >= 0
    assert known.sum() > 180
    far = np.linalg.norm(store.mesh.points[near[known]] - places[known], axis=1).max()
    assert far <= np.sqrt(3) / table._side


def test_sites_that_are_no_vertices_are_no_hints():
    sites = RNG.random((300, 3))
    growing = Growing(sites)
    growing.add(np.repeat(sites[:50], 2, axis=0))
    growing.add(sites[60:61])
    table = Hints(growing._run.store)
    cells = table.cells(sites)
    assert table.near(cells).max() < 300


@pytest.mark.parametrize(
    "place", [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (-1e300, 1e300, 0.5), (0.5, np.nextafter(1, 2), -0.0)]
)
def test_places_anywhere_have_a_cell(place):
    table = Hints(store_of(RNG.random((50, 3))))
    assert 0 <= table.cell(*place) < table._side**3


def test_a_tetrahedron_alone_has_no_hints():
    table = Hints(store_of(np.eye(4, 3)))
    cell = table.cell(0.2, 0.2, 0.2)
    assert table.near_one(cell) == -1
    table.note(cell, 3)
    assert table.near_one(cell) == 3


def test_flat_and_tiny_boxes_have_cells():
    flat = RNG.random((50, 3)) * [1, 1, 1e-310]
    for sites in (flat, RNG.random((50, 3)) * 1e-310):
        table = Hints(store_of(sites))
        assert table.near_one(table.cell(*sites[3].tolist())) >= 0


@pytest.mark.parametrize("thickness", [1e-30, 1e-200, 2e-307])
def test_places_far_from_a_thin_box_have_a_cell(thickness):
    table = Hints(store_of(RNG.random((50, 3)) * [1, 1, thickness]))
    places = np.array([[0.5, 0.5, 1.0], [0.5, 0.5, -1.0], [-1.0, 0.5, 1.0], [1.0, 1.0, 1.0]])
    cells = table.cells(places)
    assert cells.tolist() == [table.cell(*place.tolist()) for place in places]
    assert (cells % table._side).tolist() == [table._side - 1, 0, table._side - 1, table._side - 1]


def test_the_table_is_made_again_when_there_are_many_more_sites(monkeypatch):
    monkeypatch.setattr(hints, "MOST_GROWTH", 2)
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

"""The hash table against a dict, and the dead faces against what they stand for."""

import itertools

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv
from dt3d.extrapolation import dictionary
from dt3d.extrapolation.dead_faces import (
    distinct,
    insert_boundary_faces,
    insert_dead_faces,
    no_dead_faces,
    open_faces,
)
from dt3d.extrapolation.faces import Face, Tetrahedron, face_key, face_of, opposite

MACHINES = (sv.Device(), sv.Simulated(processors=3))
keys = st.lists(st.tuples(*[st.integers(-3, 3)] * 2), max_size=40)


def vectors(machine, rows, width):
    array = np.array(rows, np.int32).reshape(-1, width)
    return tuple(machine.vector(c.copy()) for c in array.T)


@given(st.lists(keys, max_size=4), keys)
def test_insert_and_look_up_as_a_dict(batches, asked):
    for machine in MACHINES:
        table, serial, entries = dictionary.empty(machine, 2), {}, 0
        for batch in batches:
            table, holders = dictionary.insert(table, vectors(machine, batch, 2))
            want = [serial.setdefault(key, entries + i) for i, key in enumerate(batch)]
            entries += len(batch)
            assert holders.to_numpy().tolist() == want
        found = dictionary.look_up(table, vectors(machine, asked, 2))
        assert found.to_numpy().tolist() == [serial.get(key, dictionary.ABSENT) for key in asked]


def test_the_table_grows_and_forgets_nothing():
    machine = MACHINES[0]
    table = dictionary.empty(machine, 1)
    for k in range(4):
        numbers = np.arange(1000 * k, 1000 * (k + 1))
        table, holders = dictionary.insert(table, vectors(machine, numbers * 7919, 1))
        np.testing.assert_array_equal(holders.to_numpy(), numbers)
        assert len(table.table) >= dictionary.SLOTS_PER_ENTRY * len(table.keys[0])
    found = dictionary.look_up(table, vectors(machine, np.arange(5000) * 7919, 1))
    np.testing.assert_array_equal(found.to_numpy(), np.r_[np.arange(4000), np.full(1000, dictionary.ABSENT)])


def test_keys_that_share_a_slot_find_others(monkeypatch):
    monkeypatch.setattr(
        dictionary, "hash32", lambda key: key[0].astype("uint32") * 0 + 1023
    )  # and wrap round

    def first_probe(index, key, slots):
        slot = dictionary.hash32(key) & (slots - 1)
        return dictionary._Probe(index, key, slot.astype("int32"))

    monkeypatch.setattr(dictionary, "_first_probe", first_probe)  # not the kernel compiled with the real hash
    machine = MACHINES[0]
    table, holders = dictionary.insert(dictionary.empty(machine, 1), vectors(machine, [5, 6, 5, 7, 6], 1))
    assert holders.to_numpy().tolist() == [0, 1, 0, 3, 1]
    found = dictionary.look_up(table, vectors(machine, [7, 8, 5], 1))
    assert found.to_numpy().tolist() == [3, dictionary.ABSENT, 0]


@pytest.mark.parametrize("k", range(4))
def test_a_face_and_its_opposite_vertex_keep_the_orientation(k):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    t = Tetrahedron(*(np.int32(i) for i in range(4)))
    a, b, c = corners[[int(i) for i in face_of(t, np.int32(k))]]
    assert np.linalg.det([b - a, c - a, corners[k] - a]) > 0


def test_keys_tell_the_sides_apart_and_nothing_else():
    side = {tuple(map(int, face_key(Face(*map(np.int32, p))))) for p in [(4, 7, 9), (7, 9, 4), (9, 4, 7)]}
    other = {tuple(map(int, face_key(Face(*map(np.int32, p))))) for p in [(4, 9, 7), (9, 7, 4), (7, 4, 9)]}
    assert side == {(4, 7, 9, 0)}
    assert other == {(4, 7, 9, 1)}
    f = Face(*map(np.int32, (4, 7, 9)))
    assert tuple(map(int, face_key(opposite(f)))) == (4, 7, 9, 1)


def tetrahedra(machine, rows):
    return Tetrahedron(*vectors(machine, rows, 4))


def as_rows(record):
    return np.stack([v.to_numpy() for v in record], axis=1).tolist()


def test_each_tetrahedron_is_kept_once():
    machine = MACHINES[0]
    rows = [*itertools.permutations([3, 1, 8, 5]), [1, 3, 5, 9], [9, 5, 3, 1], [3, 1, 8, 5]]
    assert as_rows(distinct(tetrahedra(machine, rows))) == [[3, 1, 8, 5], [1, 3, 5, 9]]


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_of_two_tetrahedra_on_one_side_of_a_face_the_first_stays(machine):
    dead = no_dead_faces(machine)
    # the second has the first's face (0, 1, 2) with its own fourth vertex on the same side
    dead, kept, lost = insert_dead_faces(
        dead, tetrahedra(machine, [[0, 1, 2, 3], [0, 1, 2, 4], [5, 6, 7, 8]]), 0
    )
    assert as_rows(kept) == [[0, 1, 2, 3], [5, 6, 7, 8]]
    assert lost == 1
    # also against an earlier batch; a neighbour on the other side is no contradiction
    dead, kept, lost = insert_dead_faces(dead, tetrahedra(machine, [[2, 0, 1, 9], [1, 0, 2, 9]]), 2)
    assert as_rows(kept) == [[1, 0, 2, 9]]
    assert lost == 1
    dead, lost = insert_boundary_faces(dead, Face(*vectors(machine, [[0, 1, 2], [30, 31, 32]], 3)))
    assert lost == 1


def test_outward_faces_are_open_unless_dead():
    machine = MACHINES[0]
    both = tetrahedra(machine, [[0, 1, 2, 3], [1, 0, 2, 9]])  # they share the face 0 1 2
    dead, kept, _ = insert_dead_faces(no_dead_faces(machine), both, 0)
    opened = {frozenset(f) for f in as_rows(open_faces(dead, kept))}
    assert opened == {
        frozenset(f) for f in [(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 2, 9), (1, 2, 9), (0, 1, 9)]
    }

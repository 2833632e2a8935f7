"""Dictionaries, against those of Python."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import dt3d
import scanvec as sv
from dt3d.extrapolation import dictionary

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


def full_dictionary(slots):
    """All slots are taken by one entry."""
    return dictionary.Dictionary(MACHINES[0].full(slots, 0, np.int32), (MACHINES[0].full(1, 5, np.int32),))


def test_a_full_dictionary_is_not_searched_for_ever():
    table = full_dictionary(16)
    assert dictionary.look_up(table, (MACHINES[0].full(1, 5, np.int32),)).to_numpy().tolist() == [0]
    with pytest.raises(dt3d.InternalError, match="a key has looked at all 16 slots.*please report"):
        dictionary.look_up(table, (MACHINES[0].full(1, 7, np.int32),))
    with pytest.raises(dt3d.InternalError, match="a key has looked at all 16 slots"):
        dictionary.insert(table, (MACHINES[0].full(2, 7, np.int32),))

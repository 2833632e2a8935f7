"""Functions of one element that are called with vectors."""

import jax.numpy as jnp
import numpy as np
import pytest

import scanvec as sv

from .cases import MACHINES, assert_same


@sv.elementwise
def clipped(x, least):
    return jnp.maximum(x, least)


@sv.elementwise
def both(pair, k):
    return {"low": clipped(pair[0], k), "high": pair[1]}


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_vectors_records_and_scalars(machine):
    v, w = machine.vector([4, 1, 7]), machine.vector([0.5, 1.5, 2.5])
    assert_same(clipped(v, 3), np.array([4, 3, 7]))
    out = both((v, w), 3)
    assert_same(out["low"], np.array([4, 3, 7]))
    assert_same(out["high"], np.array([0.5, 1.5, 2.5]))
    assert_same(clipped(v, 5, where=v > 2, otherwise=-1), np.array([5, -1, 7]))


def test_it_is_a_map_of_one_step_and_keeps_its_name():
    cm = sv.Simulated(4)
    v = cm.vector([4, 1, 7])
    cm.ledger.entries.clear()
    clipped(v, 3)
    assert [(e.operation, e.elements, e.operations) for e in cm.ledger.entries] == [("map", 3, 1)]
    assert clipped.__name__ == "clipped"


def test_without_vectors_it_is_the_function():
    assert clipped(2, 3) == 3

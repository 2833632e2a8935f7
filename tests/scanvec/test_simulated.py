"""Machines of P processors: loads on further ones, and what the constructor checks."""

import numpy as np
import pytest

import scanvec as sv

from .cases import (
    program,
)


@pytest.mark.parametrize("processors", [1, 2, 7, 32, 1000])
def test_loads_on_further_machines_are_those_of_runs_on_them(processors):
    one = sv.Simulated(5, also=(3, processors))
    other = sv.Simulated(processors)
    assert np.array_equal(program(one), program(other))
    assert list(one.ledgers) == [5, *dict.fromkeys((3, processors))]
    assert one.ledgers[processors] == other.ledger


def test_what_it_says_of_itself():
    assert repr(sv.Simulated(8)) == "Simulated(processors=8)"
    assert repr(sv.Simulated(8, model=sv.MESH2D)) == "Simulated(processors=8, model=scanvec.MESH2D)"
    assert [sv.Simulated(4).vp_ratio(n) for n in (0, 1, 4, 5, 9)] == [1, 1, 1, 2, 3]

"""Unit steps of the abstract machines, by hand: 8 elements on 4 processors."""

import pytest

import scanvec as sv

from .cases import count_letters, square_and_sum, unit_steps


@pytest.mark.parametrize(
    ("model", "steps"),
    [
        # 2 products; 2 sweeps over 2 elements, and across: one step, or a tree over four, up and down
        (sv.SCAN, 2 + 4 + 1),
        (sv.CRCW_PRAM, 2 + 4 + 4),
        (sv.EREW_PRAM, 2 + 4 + 4),
    ],
)
def test_unit_steps_of_a_sum(model, steps):
    assert unit_steps(square_and_sum, model) == steps


@pytest.mark.parametrize(
    ("model", "steps"),
    [
        (sv.SCAN, 2 + 2),
        (sv.CRCW_PRAM, 2 + 2),
        # concurrent: 1 + log2(4) times as long
        (sv.EREW_PRAM, 6 + 6),
    ],
)
def test_unit_steps_of_concurrent_accesses(model, steps):
    assert unit_steps(count_letters, model) == steps

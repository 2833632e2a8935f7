"""Unit steps of the networks, by hand: 8 elements on 4 processors."""

import pytest

import scanvec as sv

from .cases import count_letters, square_and_sum, unit_steps


@pytest.mark.parametrize(
    ("model", "steps"),
    [
        # 2 products; 2 sweeps over 2 elements; one exchange for each of two dimensions
        (sv.HYPERCUBE, 2 + 4 + 2),
        # three sweeps of two rows
        (sv.MESH2D, 2 + 4 + 6),
    ],
)
def test_unit_steps_of_a_sum(model, steps):
    assert unit_steps(square_and_sum, model) == steps


@pytest.mark.parametrize("model", [sv.HYPERCUBE, sv.MESH2D], ids=repr)
def test_the_diameter_and_the_busiest_processor_s_messages_come_on_top(model):
    assert unit_steps(count_letters, model) == 2 + 2 + 4 + 2 + 2 + 5

"""Sets with ties."""

import pytest

from ...families import body_centred, box, grid, jittered, random_integers
from .steps import assert_equal_to_insertion, compiled

TIED = {
    "grid": grid(9),
    "slab": box(20, 20, 3),
    "body-centred lattice": body_centred(7),
    "tenths": grid(9) * 0.1,
    "jitter 1e-15": jittered(9, 1e-15),
    "random integers": random_integers(2000, 12),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", TIED)
def test_sets_with_ties(name):
    found, _ = compiled(TIED[name])
    assert_equal_to_insertion(TIED[name], found)
    assert found.counts.exact_decisions > 0

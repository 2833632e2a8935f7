"""The tables against the curve computed bit by bit."""

import itertools

import numpy as np
import pytest

from dt3d.ordering import hilbert


def bit_by_bit(cell, bits):
    """The place of a cell of 2^bits a side along the curve (J. Skilling, AIP Conf. Proc. 707, 2004)."""
    x = list(cell)
    for i in reversed(range(1, bits)):
        low = (1 << i) - 1
        for k in range(len(x)):
            if x[k] >> i & 1:
                x[0] ^= low
            else:
                swap = (x[0] ^ x[k]) & low
                x[0] ^= swap
                x[k] ^= swap
    for k in range(1, len(x)):
        x[k] ^= x[k - 1]
    turn = 0
    for i in range(1, bits):
        if x[-1] >> i & 1:
            turn ^= (1 << i) - 1
    place = 0
    for i in reversed(range(bits)):
        for c in x:
            place = place << 1 | (c ^ turn) >> i & 1
    return place


@pytest.mark.parametrize("bits", [1, 2, 3, 5, 21])
def test_places_in_space_are_those_that_are_computed_bit_by_bit(bits):
    cells = np.random.default_rng(bits).integers(0, 1 << bits, (300, 3))
    finer = hilbert.SPACE_BITS - bits
    for cell in cells.tolist():
        place = int(hilbert.place_in_space(*(c << finer for c in cell))) >> 3 * finer
        assert place == bit_by_bit(cell, bits)


@pytest.mark.parametrize(("place", "d", "most"), [
    (hilbert.place_in_plane, 2, hilbert.PLANE_BITS), (hilbert.place_in_space, 3, hilbert.SPACE_BITS),
])  # fmt: skip
def test_places_are_all_and_cells_in_a_row_share_a_side(place, d, most):
    bits = 4
    cells = list(itertools.product(range(1 << bits), repeat=d))
    places = [int(place(*(c << most - bits for c in cell))) >> d * (most - bits) for cell in cells]
    assert sorted(places) == list(range(len(cells)))
    path = np.array(cells)[np.argsort(places)]
    assert (np.abs(np.diff(path, axis=0)).sum(axis=1) == 1).all()


def test_keys_have_the_place_above_the_number():
    rng = np.random.default_rng(0)
    for d, keys_of, place_of, most in (
        (2, hilbert.keys_in_plane, hilbert.place_in_plane, hilbert.PLANE_BITS),
        (3, hilbert.keys_in_space, hilbert.place_in_space, hilbert.SPACE_BITS),
    ):
        sites = rng.random((40, d))
        grid = hilbert.Grid((0.0,) * d, 1.0, 1.0, 2.0**9, 9, 6)
        keys = np.empty(30, np.uint64)
        keys_of(sites, grid, keys, 10)
        for i, key in enumerate(keys.tolist(), 10):
            cell = [int(c * 2**9) << most - 9 for c in sites[i]]
            assert key == (int(place_of(*cell)) >> d * (most - 9)) << 6 | i

"""The rounds of insertion."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from dt3d.ordering.brio import SMALLEST_ROUND, brio, insertion_rounds, rounds_of


@given(st.integers(5, 3000), st.integers(0, 2**31), st.sets(st.integers(0, 4), min_size=4, max_size=4))
def test_rounds_have_all_sites_once_in_ascending_order(n, seed, left_out):
    sequence, ends = insertion_rounds(n, seed, np.array(sorted(left_out), np.int32))
    assert sorted([*sequence.tolist(), *left_out]) == list(range(n))
    assert ends[-1] == len(sequence)
    for begin, end in zip([0, *ends], ends, strict=False):
        assert (np.diff(sequence[begin:end].astype(int)) > 0).all()


def test_rounds_grow_fourfold():
    n = 200_000
    _, ends = insertion_rounds(n, 0, np.arange(4, dtype=np.int32))
    assert SMALLEST_ROUND < ends[0] < 5 * SMALLEST_ROUND
    want = n / 4.0 ** np.arange(len(ends))[::-1]
    assert (np.abs(ends - want) < 6 * np.sqrt(want)).all()


def test_rounds_double_and_go_along_the_rows():
    n, parts = 40_000, 3
    part = (np.arange(n) * parts // n).astype(np.int32)
    order, starts = brio(part, parts, 0)
    assert sorted(order) == list(range(n))
    sizes = np.diff(starts, axis=1)
    assert sizes.shape == (parts, rounds_of(n))
    for k in range(parts):
        for r in range(rounds_of(n)):
            sites = order[starts[k, r] : starts[k, r + 1]]
            assert (part[sites] == k).all()
            assert (np.diff(sites) > 0).all()
    total = sizes.sum(axis=0)
    assert np.all(np.abs(total[-3:] / n - [1 / 8, 1 / 4, 1 / 2]) < 0.01)

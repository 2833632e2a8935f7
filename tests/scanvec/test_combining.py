"""Concurrent writes of blocks."""

import numpy as np
import pytest

import scanvec as sv
from scanvec._machine import combining
from scanvec._monoid import UNIQUE
from scanvec._running import computing

PLACE = np.array([0, 2, 0, 99])  # the last is beyond the block
VALUES = np.array([5, 3, 6, 1], np.int8)


@pytest.mark.parametrize(
    ("op", "first"),
    [(sv.ADD, 12), (sv.MUL, 30), (sv.MIN, 1), (sv.MAX, 6), (sv.AND, 0), (sv.OR, 7), (sv.COPY, 5)],
    ids=str,
)
def test_every_operator(op, first):
    with computing():
        got = combining.put(op, np.ones(3, np.int8), PLACE, VALUES)
        flags = combining.put(op, np.zeros(3, bool), PLACE, VALUES > 5) if op.kinds != "iuf" else None
    assert got[0] == first
    assert got[1] == 1
    assert flags is None or flags.tolist() == [op in (sv.MAX, sv.OR), False, False]


def test_what_an_exclusive_write_is():
    with computing():
        got = combining.put(UNIQUE, np.zeros((2, 2)), np.array([[3, 0]]), np.array([[1.5, 2.5]]))
        assert got.tolist() == [[2.5, 0], [0, 1.5]]
        assert int(combining.most_accesses(3, PLACE)) == 2

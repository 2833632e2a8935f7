"""Machines that are one device."""

import numpy as np

import scanvec as sv
from scanvec._machine.blocks import SMALLEST_BLOCK


def test_vectors_beyond_the_smallest_block():
    device = sv.Device()
    for n in (0, SMALLEST_BLOCK, SMALLEST_BLOCK + 1):
        v = device.iota(n)
        assert np.array_equal(v.to_numpy(), np.arange(n))
        assert np.array_equal(sv.get(v, n - 1 - v), np.arange(n)[::-1])


def test_it_keeps_no_ledger():
    assert sv.Device().ledger is None
    assert repr(sv.Device()) == "Device()"

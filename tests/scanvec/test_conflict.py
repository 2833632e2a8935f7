"""Exclusive access: what is reported, and what is raised."""

import numpy as np
import pytest

import scanvec as sv


def test_exclusive_access_is_reported_with_primitive_and_phase():
    cm = sv.Simulated(4, model=sv.EREW_PRAM)
    v = cm.vector(np.arange(8))
    with cm.phase("exclusive"):
        sv.permute(v, cm.vector(np.arange(8)[::-1]))
        sv.get(v, v)
    with cm.phase("everyone reads one"):
        sv.get(v, cm.vector(np.zeros(8, int)))
    with cm.phase("some write one"):
        where = cm.vector(np.arange(8) < 3)
        sv.send(v, cm.vector(np.zeros(8, int)), sv.ADD, into=v, where=where)
    assert [(c.phase, c.primitive, c.step, c.accesses) for c in cm.ledger.conflicts] == [
        ("everyone reads one", "get", 2, 8),
        ("some write one", "send", 3, 3),
    ]
    assert "read by 8 elements at once" in str(cm.ledger.conflicts[0])
    assert "in phase 'some write one': one place was written by 3" in str(cm.ledger.conflicts[1])


def test_exclusive_access_can_be_enforced():
    cm = sv.Simulated(4, model=sv.EREW_PRAM, on_conflict="raise")
    v = cm.vector(np.arange(8))
    with (
        cm.phase("p"),
        pytest.raises(sv.ConcurrentAccessError, match="get.*in phase 'p'.*exclusive") as error,
    ):
        sv.get(v, cm.vector(np.zeros(8, int)))
    assert error.value.conflict.accesses == 8
    assert not cm.ledger.entries
    with pytest.raises(ValueError, match="'report' or 'raise', got 'ignore'"):
        sv.Simulated(4, on_conflict="ignore")


def test_concurrent_access_is_no_conflict_elsewhere():
    cm = sv.Simulated(4, model=sv.CRCW_PRAM, on_conflict="raise")
    v = cm.vector(np.arange(8))
    sv.get(v, cm.vector(np.zeros(8, int)))
    assert not cm.ledger.conflicts

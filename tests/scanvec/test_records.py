"""Records: trees of vectors."""

import numpy as np
import pytest

import scanvec as sv
from scanvec import _records

M = sv.Device()
V, W = M.vector([1, 2]), M.vector([0.5, 1.5])


def test_what_is_known_of_a_record():
    record = {"a": V, "b": (W, V)}
    assert [v is w for v, w in zip(_records.vectors_of(record), (V, W, V), strict=True)] == [True] * 3
    assert _records.machine_of(record) is M
    assert _records.length_of(record) == 2
    assert _records.has_vectors((1, V))
    assert not _records.has_vectors((1, 2.5))
    assert _records.structure_of((V, W)) == _records.structure_of((1, 2))


def test_each_keeps_the_structure():
    out = _records.each(lambda v, k: len(v) + k, (V, {"b": W}), (1, {"b": 2}))
    assert out == (3, {"b": 4})
    assert np.array_equal(_records.blocks_of((V, 3))[0][:2], [1, 2])


def test_two_kinds():
    _records.check_one_kind("f", (V, W), (V, W))
    with pytest.raises(ValueError, match="f: the two records have different structures"):
        _records.check_one_kind("f", (V, W), [V, W])
    with pytest.raises(ValueError, match="f: the two records have different dtypes"):
        _records.check_one_kind("f", V, W)

"""What another process compiles is what the first call needs."""

import numpy as np

from dt3d.insertion import first_call, triangulate
from dt3d.insertion.compaction import count_finite, number_finite, write_finite
from dt3d.insertion.insert import insert


def test_the_types_are_those_of_a_run():
    first_call.compile_insert()
    first_call.compile_compaction()
    for points in (np.random.default_rng(0).random((9000, 3)), np.random.default_rng(0).random((9, 3)) * 1e9):
        triangulate(points, threads=2)
    for kernel in (insert, count_finite, number_finite, write_finite):
        assert len(kernel.overloads) == 1
    assert first_call.insert_beside() is first_call.compile_conflicts  # there is nothing left to compile


def test_a_process_leaves_this_one_to_compile_and_to_wait(monkeypatch):
    called = []
    monkeypatch.setattr(first_call, "compiled_beside", lambda *_: lambda: called.append("waited"))
    for name in ("compile_conflicts", "compile_compaction"):
        monkeypatch.setattr(first_call, name, lambda name=name: called.append(name))
    first_call.insert_beside()()
    assert called == ["compile_conflicts", "compile_compaction", "waited"]

"""What another process compiles is what the first call in the plane needs."""

import numpy as np

import dt3d
from dt3d.threaded2d.in_place import first_call
from dt3d.threaded2d.in_place.star import METHOD


def test_the_types_are_those_of_a_run():
    first_call.compile_steps()
    for n in (9000, 9):
        dt3d.Delaunay(np.random.default_rng(0).random((n, 2)), threads=2)
    assert len(METHOD.run.overloads) == 1
    assert first_call.steps_beside()() is None  # there is nothing left to compile


def test_a_process_leaves_this_one_to_compile_and_to_wait(monkeypatch):
    called = []
    monkeypatch.setattr(first_call, "compiled_beside", lambda *_: lambda: called.append("waited"))
    monkeypatch.setattr(first_call, "compact", lambda *_: called.append("compiled"))
    first_call.steps_beside()()
    assert called == ["compiled", "waited"]

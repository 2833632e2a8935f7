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

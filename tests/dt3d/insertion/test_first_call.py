"""What another process compiles is what the first call needs."""

import numpy as np

from dt3d.insertion import first_call, triangulate
from dt3d.insertion.compaction import count_finite, number_finite, write_finite
from dt3d.insertion.insert import insert


def test_the_types_are_those_of_a_run():
    first_call.compile_insert()
    first_call.compile_the_rest()
    for points in (np.random.default_rng(0).random((9000, 3)), np.random.default_rng(0).random((9, 3)) * 1e9):
        triangulate(points, threads=2)
    for kernel in (insert, count_finite, number_finite, write_finite):
        assert len(kernel.overloads) == 1
    assert first_call.insert_beside()() is None  # there is nothing left to compile

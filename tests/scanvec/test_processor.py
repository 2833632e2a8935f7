"""One processor's program: with collectives on many processors, as it is on one."""

from functools import partial

import jax
import numpy as np
import pytest

import scanvec as sv
from scanvec._machine import blocks, processor
from scanvec._running import computing

VALUES = np.array([5, 1, 3, 4, 3, 9, 2], np.int32)
HEADS = np.array([True, False, False, True, True, False, False])


@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize("exclusive", [False, True])
@pytest.mark.parametrize("op", [sv.ADD, sv.COPY], ids=lambda op: op.name)
@pytest.mark.parametrize("segmented", [False, True])
def test_many_processors_scan_as_one_does(op, exclusive, backward, segmented):
    one = partial(processor.scan, op, exclusive, backward)
    n, vp, p = len(VALUES), 2, 4
    with computing():
        want = one(True, VALUES, HEADS if segmented else None, n, n)
        rows = np.append(VALUES, 77).reshape(p, vp)  # one place is padding
        heads = np.append(HEADS, True).reshape(p, vp) if segmented else None
        many = jax.vmap(partial(one, False), (0, 0, None, None), axis_name=processor.PROCESSORS)
        got = many(rows, heads, n, vp)
    assert np.array_equal(got.reshape(-1)[:n], want)


def test_what_a_processor_holds():
    with computing():
        holds = jax.vmap(lambda _: processor.in_use(3, 5, 2, False), axis_name=processor.PROCESSORS)(
            np.arange(4)
        )
    # rows of three places with two elements each: 2, 2, 1 and none
    assert np.array_equal(holds.sum(1), [2, 2, 1, 0])
    assert np.array_equal(processor.in_use(3, 2, 2, True), [True, True, False])


def test_span_of_all_processors():
    index = np.array([[4, -1], [7, 9]])
    active = np.array([[True, False], [True, False]])
    with computing():
        span = jax.vmap(partial(processor.span, alone=False), axis_name=processor.PROCESSORS)
        least, greatest = span(index, active)
        assert (least.tolist(), greatest.tolist()) == ([4, 4], [7, 7])
        assert [int(x) for x in processor.span(index, active & False, True)] == [0, -1]


def test_get_reads_all_rows():
    block = blocks.to_blocks(np.arange(10, 18), 4)
    place = np.array([[1, processor.NOWHERE], [0, block.shape[1]], [0, 0], [1, 1]], np.int32)
    with computing():
        got = blocks.get(block, place, -1)
    assert got.tolist() == [[11, -1], [10, 12], [10, 10], [11, 11]]

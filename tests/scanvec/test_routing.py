"""Routes: places, and messages between processors, against loops over the indices."""

import numpy as np
import pytest

from scanvec._machine import blocks, routing
from scanvec._running import computing


def counted_by_hand(index, where, m, processors):
    """Messages that each processor sends and receives."""
    sent, received = np.zeros((2, processors), int)
    for i, j in enumerate(index):
        asker = i // blocks.vp_ratio(len(index), processors)
        owner = j // blocks.vp_ratio(m, processors)
        if where[i] and asker != owner:
            sent[asker] += 1
            received[owner] += 1
    return sent, received


@pytest.mark.parametrize("replies", [False, True])
@pytest.mark.parametrize(("n", "m"), [(10, 7), (3, 100), (64, 64)])
def test_messages(replies, n, m):
    rng = np.random.default_rng(n)
    index, where = rng.integers(0, m, n), rng.random(n) < 0.8
    block, context = (blocks.to_blocks(x, 4) for x in (index, where))
    at = routing.layout(n, m, 4)
    others = 3, 16
    vps = [np.array([blocks.vp_ratio(k, p) for p in others], np.int32) for k in (n, m)]
    with computing():
        place, facts, handled = routing.find(replies, block, context, at)
        elsewhere = routing.loads_elsewhere(replies, others, block, context, at, *vps)
    least, greatest, total, busiest = np.asarray(facts)
    assert (least, greatest) == (index[where].min(), index[where].max())
    values = blocks.to_blocks(np.arange(m), 4).reshape(-1)
    assert np.array_equal(values[blocks.from_blocks(np.asarray(place), n)[where]], index[where])
    loads = [total, busiest], *np.asarray(elsewhere).reshape(-1, 2).tolist()
    for processors, got in zip((4, *others), loads, strict=True):
        sent, received = counted_by_hand(index, where, m, processors)
        want = sent + received if replies else np.maximum(sent, received)
        assert list(got) == [sent.sum() * (2 if replies else 1), want.max()]
    sent, received = counted_by_hand(index, where, m, 4)
    assert np.array_equal(handled, sent + received if replies else np.maximum(sent, received))

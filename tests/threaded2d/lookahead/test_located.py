"""Sites located ahead: each once, with the leaf that contains it, and in the order of location."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.configuration import INTERLEAVED
from dt3d.threaded2d.dag import locate
from dt3d.threaded2d.location import DAG, WALK
from dt3d.threaded2d.lookahead.located import locate_ahead, next_located, nothing_located
from dt3d.threaded2d.queue import ITEM_NODE, ITEM_SITE
from dt3d.threaded2d.work_sharing import share

from ..families import uniform
from ..runs import half_inserted


def _begun():
    store, others = half_inserted(uniform(200))
    store.state[0, c.HINT] = locate(store.mesh(), int(others[0]))[0]
    store.state[0, c.VISITED] = 0
    return store, others, share(others, np.array([0, len(others)])), nothing_located(1, INTERLEAVED)


@pytest.mark.parametrize("location", [DAG, WALK])
@pytest.mark.parametrize("ahead", [1, 3, INTERLEAVED])
def test_every_site_is_located_and_taken_once(location, ahead):
    store, others, schedule, lookahead = _begun()
    mesh, state = store.mesh(), store.state[0]
    located, taken, left = [], [], True
    while left:
        while left and state[c.LOCATED_END] < ahead:
            left = locate_ahead(mesh, 0, schedule, lookahead, location)
            if left:
                item = lookahead.located[0, state[c.LOCATED_END] - 1]
                located.append((int(item[ITEM_SITE]), int(item[ITEM_NODE])))
        while state[c.LOCATED_END] > 0:
            taken.append(tuple(next_located(mesh, 0, lookahead)))
            assert len(taken) <= len(located)
            assert state[c.LOCATED_AT] < max(1, state[c.LOCATED_END])
    assert taken == located
    assert sorted(q for q, _ in taken) == sorted(others.tolist())
    ways = {int(q): locate(mesh, q) for q in others}
    assert dict(taken) == {q: t for q, (t, _) in ways.items()}
    if location == WALK:
        assert [q for q, _ in taken] == others.tolist()  # one after the other
        assert state[c.HINT] == taken[-1][1]
    else:
        assert state[c.VISITED] == sum(visited for _, visited in ways.values())
    assert (schedule.taker == 0).all()


def test_nothing_left_is_nothing_located():
    store, _, _, lookahead = _begun()
    nothing = share(np.empty(0, np.int64), np.array([0, 0]))
    for location in (DAG, WALK):
        assert not locate_ahead(store.mesh(), 0, nothing, lookahead, location)
    assert store.state[0, c.LOCATED_END] == 0
    assert store.state[0, c.VISITED] == 0

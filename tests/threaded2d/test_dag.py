"""Location in the history, node by node: a child contains what its parent contains."""

import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.dag import child_of, descend, locate
from dt3d.threaded2d.geometry import root_of

from .families import EVERY_SET
from .runs import half_inserted
from .stepping import orientation


def _contains(store, t, q):
    row = store.nodes[t, :3].tolist()
    edges = [(row[k], row[(k + 1) % 3]) for k in range(3)]
    return all(orientation(store.points, a, b, q) >= 0 for a, b in edges if min(a, b) >= 0)


@pytest.mark.parametrize("name", EVERY_SET)
def test_every_node_on_the_way_contains_the_site(name):
    store, others = half_inserted(EVERY_SET[name](120))
    mesh, by_flips = store.mesh(), 0
    for q in others.tolist():
        t, steps = root_of(mesh, q), 0
        while store.nodes[t, c.CHILD] >= 0:
            assert _contains(store, t, q)
            children = int(store.nodes[t, c.CHILD])
            t = child_of(mesh, t, children, q)
            by_flips += not children & 1
            assert 0 <= t - children // 2 < (3 if children & 1 else 2)
            steps += 1
        assert _contains(store, t, q)
        assert locate(mesh, q) == (t, steps)
        assert descend(mesh, t, q) == (t, 0)
    # sites in convex position are all beyond the hull, where subdivisions lead
    assert by_flips > 0 or name in ("arc", "circle_of_integers")

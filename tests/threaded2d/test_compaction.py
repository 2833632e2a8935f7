"""What is left in the end, against the leaves that Python finds."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d import compaction
from dt3d.threaded2d.compaction import compact

from .families import EVERY_SET
from .runs import inserted
from .stepping import leaves


@pytest.mark.parametrize("name", EVERY_SET)
@pytest.mark.parametrize("chunk_bits", [4, 14])
def test_all_finite_leaves_and_their_neighbours(name, chunk_bits, monkeypatch):
    if chunk_bits != compaction.CHUNK_BITS:
        # several chunks of a small set, by the same code without a compiler
        monkeypatch.setattr(compaction, "CHUNK_BITS", chunk_bits)
        for kernel in ("_number", "_write"):
            monkeypatch.setattr(compaction, kernel, getattr(compaction, kernel).py_func)
    store, _ = inserted(EVERY_SET[name](60))
    nodes = store.nodes[: store.used]
    site = np.random.default_rng(0).permutation(len(store.points))
    kept = [t for t in leaves(store).tolist() if nodes[t, :3].min() >= 0]
    number = {t: i for i, t in enumerate(kept)}
    for threads in (1, 3):
        out = compact(nodes, site, threads)
        np.testing.assert_array_equal(out.triangles, site[nodes[kept, :3]])
        assert out.neighbors.tolist() == [
            [number.get(edge // 4, -1) for edge in nodes[t, c.NEIGHBOR : c.NEIGHBOR + 3].tolist()]
            for t in kept
        ]
        np.testing.assert_array_equal(out.thread, -1 - nodes[kept, c.CHILD])
        assert [a.dtype for a in out] == [np.int32, np.int32, np.int16]


def test_room_for_the_result():
    store, _ = inserted(
        EVERY_SET["uniform"](60) if "uniform" in EVERY_SET else next(iter(EVERY_SET.values()))(60)
    )
    nodes, site = store.nodes[: store.used], np.arange(len(store.points))
    want = compact(nodes, site)
    m = len(want.triangles)
    own = np.full((2, m + 5, 3), 7, np.int32)
    out = compact(nodes, site, room=lambda needed: (own[0, :needed], own[1, :needed]))
    np.testing.assert_array_equal(own[:, :m], [want.triangles, want.neighbors])
    assert (own[:, m:] == 7).all()
    assert np.shares_memory(out.triangles, own)

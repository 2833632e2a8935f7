"""Triangulations that are still growing, for tests of a single step."""

import threading
import time

import numpy as np

from dt3d._first_tetrahedron import first_tetrahedron
from dt3d.insertion.mesh import FREE, INFINITE, Site, neighbors, vertices
from dt3d.insertion.store import Store
from dt3d.insertion.team import Team
from dt3d.insertion.worker import State


def rows_of(points):
    """The sites as they lie in memory, float64 (4 n,)."""
    return np.concatenate([points, np.zeros((len(points), 1))], axis=1).ravel()


def grown(points, inserted, block=64):
    """A team of one thread that has inserted the first sites of ``points`` in their order."""
    first = first_tetrahedron(np.ascontiguousarray(points[:inserted]), 0)
    store = Store(rows_of(points), first, 16 * len(points) + 64, block)
    box = np.array([points.min(axis=0), points.max(axis=0)])
    team = Team(1, store, box, lambda inserted, slots: None)
    team.insert_round(np.setdiff1d(np.arange(inserted), first).astype(np.uint32))
    return team


def living(team):
    """The slots that hold tetrahedra, ghosts included."""
    state = team.workers[0].state
    slots = np.arange(team.store.used)
    fresh = (slots >= state[State.FRESH]) & (slots < state[State.FRESH_END])
    return np.flatnonzero(~fresh & (vertices(team.store.mesh)[slots, 0] != FREE))


def is_ghost(mesh, t):
    return (vertices(mesh)[t] == INFINITE).any()


def site(points, v):
    return Site(v, *points[v].tolist())


def check_links(team):
    """Neighbours name each other, and share the vertices of the facet."""
    corners, across, slots = vertices(team.store.mesh), neighbors(team.store.mesh), living(team)
    for t in slots:
        for k in range(4):
            u, j = divmod(int(across[t, k]), 4)
            assert across[u, j] == 4 * t + k
            assert sorted(np.delete(corners[t], k)) == sorted(np.delete(corners[u], j))


def no_thread_is_left():
    """Whether all threads but this one end; the last steps of a thread come after what it says at its end."""
    deadline = time.monotonic() + 5
    while threading.active_count() > 1 and time.monotonic() < deadline:
        time.sleep(0.001)
    return threading.active_count() == 1

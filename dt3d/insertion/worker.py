"""What one thread has for itself: its counts, its free slots, room for a cavity and for exact arithmetic."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numba
import numpy as np
import numpy.typing as npt

from ..predicates import work_array
from .mesh import FREE, INFINITE, neighbors, vertices
from .store import Store

FIRST_ROOM = 1 << 10  # facets of a cavity; grown where it is not enough
TABLE_BITS = 6  # a star of up to 2^6 vertices is linked through a table of all edges


class State(IntEnum):
    """The numbers of a worker that compiled code reads and writes."""

    NEXT = 0  # place in ``todo`` of the next site
    STOP = 1  # place in ``todo`` before which a call of `insert` ends
    DEFERRED = 2  # sites at the front of ``todo`` that other threads' sites were in the way of
    LAST = 3  # the tetrahedron that the next walk begins at
    FREE = 4  # see `FreeSlots`
    FREE_COUNT = 5
    FRESH = 6
    FRESH_END = 7
    FIRST = 8  # see `ownership.Part`
    LENGTH = 9
    SITES = 10
    WALKED = 11  # steps
    TESTED = 12  # tetrahedra that were asked whether they are in conflict
    CREATED = 13  # tetrahedra


class FreeSlots(NamedTuple):
    """The first of the ``listed`` free slots in a list, and a block of slots that nobody has used."""

    first: int
    listed: int
    fresh: int
    fresh_end: int


class Scale(NamedTuple):
    """What is known of the magnitude of the coordinates."""

    slack: float  # a bound of what underflow can do to a determinant
    reach: float  # a bound of the coordinates


class Scratch(NamedTuple):
    """Room for a cavity with F facets and for the star that takes its place."""

    cavity: npt.NDArray[np.uint32]  # (F,): tetrahedra
    outer: npt.NDArray[np.uint32]  # (F,): the facet beyond each facet
    rim: npt.NDArray[np.uint32]  # (3, F): the vertices of the facets, then their numbers in the star
    p: npt.NDArray[np.uint32]  # (F,): the rows of ``rim``
    q: npt.NDArray[np.uint32]
    r: npt.NDArray[np.uint32]
    slots: npt.NDArray[np.uint32]  # (F,): the new tetrahedron at each facet
    vertices: npt.NDArray[np.uint32]  # (F,): by their numbers; 0 is the infinite one
    facet_of: npt.NDArray[np.uint32]  # (F,): a facet of each vertex
    x: npt.NDArray[np.float64]  # (F,): the vertices, relative to the site; NaN for the infinite one
    y: npt.NDArray[np.float64]
    z: npt.NDArray[np.float64]
    squared: npt.NDArray[np.float64]  # (F,): their squared lengths
    edges: npt.NDArray[np.uint32]  # a facet at each edge between vertices of small numbers
    keys: npt.NDArray[np.int64]  # (16 F,): edges in a hash table
    values: npt.NDArray[np.uint32]  # (16 F,): a facet at each


def scratch_for(facets: int) -> Scratch:
    """Room for a cavity with that many facets; as many tetrahedra; and half as many vertices."""
    rim = np.empty((3, facets), np.uint32)
    near = np.empty(facets, np.uint32)
    near[0] = INFINITE
    relative = np.empty((4, facets))
    relative[:, 0] = np.nan
    return Scratch(
        cavity=np.empty(facets, np.uint32),
        outer=np.empty(facets, np.uint32),
        rim=rim,
        p=rim[0],
        q=rim[1],
        r=rim[2],
        slots=np.empty(facets, np.uint32),
        vertices=near,
        facet_of=np.empty(facets, np.uint32),
        x=relative[0],
        y=relative[1],
        z=relative[2],
        squared=relative[3],
        edges=np.empty(1 << 2 * TABLE_BITS, np.uint32),
        keys=np.empty(16 * facets, np.int64),
        values=np.empty(16 * facets, np.uint32),
    )


SCRATCH = numba.typeof(scratch_for(1))


class Worker:
    """The state, the sites and the memory of one thread.

    Parameters
    ----------
    sites : int
        How many there are.
    box : float64 (2, 3)
        The corners of the box of all.
    """

    def __init__(self, sites: int, box: npt.NDArray[np.float64]) -> None:
        self.state = np.zeros(len(State), np.int64)
        self.state[State.SITES] = self.state[State.LENGTH] = sites
        self.work = work_array(box)  # which knows the greatest coordinate
        self.todo = np.empty(0, np.uint32)
        self.out_of_slots = False
        self.scratch = scratch_for(FIRST_ROOM)

    def assign(self, todo: npt.NDArray[np.uint32], first: int, length: int) -> None:
        """Get sites to insert, and a part of the curve to own."""
        self.todo, self.out_of_slots = todo, False
        self.state[State.FIRST], self.state[State.LENGTH] = first, length
        self.state[State.NEXT] = self.state[State.DEFERRED] = 0

    @property
    def left(self) -> npt.NDArray[np.uint32]:
        """What was deferred or not reached."""
        return np.concatenate([self.todo[: self.state[State.DEFERRED]], self.todo[self.state[State.NEXT] :]])

    @property
    def inserted(self) -> int:
        """How many of the sites to insert have been."""
        return int(self.state[State.NEXT] - self.state[State.DEFERRED])

    @property
    def unused(self) -> int:
        """Slots that it has and that hold no tetrahedron."""
        return int(self.state[State.FREE_COUNT] + self.state[State.FRESH_END] - self.state[State.FRESH])

    def take_slots(self, store: Store) -> bool:
        """Take a block of slots; whether there was one.

        What was left of the last block is put on the list of free slots where the new one does not adjoin.
        """
        begin, end = store.take_block()
        if begin == self.state[State.FRESH_END]:
            self.state[State.FRESH_END] = end
        else:
            self.give_up_block(store)
            self.state[State.FRESH], self.state[State.FRESH_END] = begin, end
        return end > begin

    def give_up_block(self, store: Store) -> None:
        """Put the fresh slots on the list of free ones."""
        corners, across = vertices(store.mesh), neighbors(store.mesh)
        for slot in range(int(self.state[State.FRESH]), int(self.state[State.FRESH_END])):
            corners[slot, 0], across[slot, 0] = FREE, self.state[State.FREE]
            self.state[State.FREE] = slot
        self.state[State.FREE_COUNT] += self.state[State.FRESH_END] - self.state[State.FRESH]
        self.state[State.FRESH] = self.state[State.FRESH_END]

"""A tree of boxes over sites in Morton order, and the descent of many queries at once.

A leaf is eight consecutive sites, an inner node eight consecutive nodes of the level below; each has the
least box of its sites. Nothing is empty in it, so surfaces and clusters cost a query what even sets do. It
fits the requests of Teng et al. 1993, section 4.2: a request for a node too large to be searched becomes
requests for its children.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from ..points import Point, T, total

FANOUT = 8
# Requests of one step; it bounds the memory. Longer lists are cut in two, one of which waits.
MOST_NODE_REQUESTS = 2**18

Q = TypeVar("Q")  # the record of a query


@dataclass(frozen=True)
class Tree:
    """Boxes of all nodes, level by level from the leaves.

    Attributes
    ----------
    low, high : Point
        Vectors over the nodes.
    first : tuple of int
        Where each level begins in them.
    sizes : tuple of int
        How many nodes each level has; at most `FANOUT` in the last.
    """

    low: Point[sv.Vector]
    high: Point[sv.Vector]
    first: tuple[int, ...]
    sizes: tuple[int, ...]


class Request(NamedTuple, Generic[T]):
    """A query that enters a node."""

    query: T  # the query's number
    node: T  # the node's number in its level


def build(sites: Point[sv.Vector]) -> Tree:
    """The tree over n sites in order."""
    low, high = _boxes_over(sites, sites)
    first, sizes = [0], [len(low.x)]
    level_low, level_high = low, high
    while sizes[-1] > FANOUT:
        level_low, level_high = _boxes_over(level_low, level_high)
        low, high = sv.append(low, level_low), sv.append(high, level_high)
        first.append(first[-1] + sizes[-1])
        sizes.append(len(level_low.x))
    return Tree(low, high, tuple(first), tuple(sizes))


def _boxes_over(low: Point[sv.Vector], high: Point[sv.Vector]) -> tuple[Point[sv.Vector], Point[sv.Vector]]:
    """The boxes of every `FANOUT` consecutive ones."""
    machine, n = low.x.machine, len(low.x)
    index = machine.iota(n)
    segments = sv.Segments.from_flags(machine.map(_begins_node, index))
    return sv.reduce(low, sv.MIN, segments), sv.reduce(high, sv.MAX, segments)


def _begins_node(index: Array) -> Array:
    return index % FANOUT == 0


def entry_test(may_contain: Callable[[Q, Point[Array], Point[Array]], Array]) -> Callable[..., Array]:
    """The step of a descent whose queries enter the boxes that ``may_contain(query, low, high)``."""

    def test(mask: Array, query: Q, low: Point[Array], high: Point[Array], exists: Array, k: Array) -> Array:
        return mask | jnp.where(exists & may_contain(query, low, high), jnp.left_shift(1, k), 0)

    return test


def descend(tree: Tree, queries: object, test: Callable[..., Array]) -> Iterator[Request[sv.Vector]]:
    """The leaves that queries, a record of vectors of length m, enter, batch by batch.

    ``test`` is an `entry_test`. Within a batch and from batch to batch the queries' numbers ascend. The list
    of what waits ends: requests go down a level, or are cut in two.
    """
    machine = tree.low.x.machine
    m = len(jax.tree.leaves(queries)[0])
    top = len(tree.sizes)
    waiting: list[tuple[int, Request[sv.Vector]]] = [
        (top, Request(machine.iota(m), machine.full(m, 0, np.int32)))
    ]
    while waiting:
        level, requests = waiting.pop()
        n = len(requests.query)
        if n > MOST_NODE_REQUESTS:
            late = machine.iota(n) >= n // 2
            waiting += [(level, sv.pack(requests, late)), (level, sv.pack(requests, ~late))]
        elif level == 0:
            yield requests
        elif n:
            waiting.append((level - 1, _enter_children(tree, queries, requests, level, test)))


def _enter_children(
    tree: Tree, queries: object, requests: Request[sv.Vector], level: int, test: Callable[..., Array]
) -> Request[sv.Vector]:
    machine, n = requests.query.machine, len(requests.query)
    query = sv.get(queries, requests.query)
    mask = machine.full(n, 0, np.int32)
    first, size = tree.first[level - 1], tree.sizes[level - 1]
    for k in range(FANOUT):
        child, exists = machine.map(_child, requests.node, k, size)
        low, high = sv.get((tree.low, tree.high), child + first, where=exists, otherwise=0)
        mask = machine.map(test, mask, query, low, high, exists, k)
    return unfold(requests, mask)


def _child(node: Array, k: Array, size: Array) -> tuple[Array, Array]:
    child = FANOUT * node + k
    return child, child < size


def unfold(requests: Request[sv.Vector], mask: sv.Vector) -> Request[sv.Vector]:
    """A request for each bit that is set: for child k of the node where bit k is."""
    machine = mask.machine
    (copies, bits), segments = sv.distribute((requests, mask), machine.map(_count_bits, mask))
    return Request(copies.query, machine.map(_nth_child, copies.node, bits, segments.offsets))


def _count_bits(mask: Array) -> Array:
    return total((mask >> k) & 1 for k in range(FANOUT))


def _nth_child(node: Array, mask: Array, nth: Array) -> Array:
    """8 node + the place of the nth bit of the mask, counted from 0."""
    place, seen = jnp.zeros_like(nth), jnp.zeros_like(nth)
    for k in range(FANOUT):
        bit = (mask >> k) & 1
        place = jnp.where((bit == 1) & (seen == nth), k, place)
        seen = seen + bit
    return FANOUT * node + place

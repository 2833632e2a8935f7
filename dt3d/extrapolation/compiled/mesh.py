"""The tetrahedra found so far, their neighbours, and the open faces, in arrays of fixed capacity.

A step takes open faces from a queue (`pop`), and, when their fourth vertices are known, makes each new
tetrahedron once and joins it to what is there (`attach`). Both change the arrays in place.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from ..._errors import InternalError
from ..._topology import OUTSIDE
from ..dictionary import ABSENT, EMPTY_SLOT
from ..faces import Face
from .chunks import at, cut, over_chunks
from .facet_table import Facet, ascending, facet_of, first_slot, insert, look_up
from .stages import FOUND, HULL, Batch, Expansion

OPEN = -2  # the neighbour of an open face; -3, -4, ...: the face in place 0, 1, ... of this step
TETRAHEDRA_PER_SITE = 8
SLOTS_PER_TETRAHEDRON = 4


class Queue(NamedTuple):
    """Half-faces whose other sides are open; those before ``head`` have been taken."""

    half: Array  # int32 (capacity,)
    bound: Array  # float32 (capacity,): an upper bound of the signed distance, where one is kept
    head: Array
    tail: Array


class Mesh(NamedTuple):
    """State of the triangulation; T is the capacity."""

    corners: Array  # int32 (4 T,): vertices of the tetrahedra
    neighbors: Array  # int32 (4 T,): the half-face on the other side, `OUTSIDE` or `OPEN`
    table: Array  # int32 (slots,), see `facet_table.py`
    fresh: Queue  # faces that have not been tried
    tetrahedra: Array  # how many there are


def face_beyond(corners: Array, half: Array) -> Face[Array]:
    """The outward face of a half-face: the positive side is where no tetrahedron is yet."""
    first, k = half & ~3, half & 3
    a = jnp.where(k == 1, 2, jnp.where(k == 2, 0, 1))
    b = jnp.where(k == 0, 2, jnp.where(k == 2, 1, 0))
    c = jnp.where(k == 3, 2, 3)
    return Face(*(at(corners, first + x) for x in (a, b, c)))


def packed(flags: Array, *values: Array) -> tuple[tuple[Array, ...], Array]:
    """The values where flags are set, in front; and how many those are. Behind them is anything."""
    size = flags.size
    place = jnp.cumsum(flags, dtype=jnp.int32)
    index = jnp.zeros(size, jnp.int32)
    index = index.at[jnp.where(flags, place - 1, size)].set(
        jnp.arange(size, dtype=jnp.int32), mode="drop", unique_indices=True
    )
    return tuple(at(v, index) for v in values), place[-1]


def append(queue: Queue, flags: Array, half: Array, bound: Array | None = None) -> Queue:
    """The queue with the half-faces whose flag is set, and their bounds where it keeps them."""
    write = jax.lax.dynamic_update_slice
    if bound is None:
        (half,), count = packed(flags, half)
        bounds = queue.bound
    else:
        (half, bound), count = packed(flags, half, bound)
        bounds = write(queue.bound, bound, (queue.tail,))
    return Queue(write(queue.half, half, (queue.tail,)), bounds, queue.head, queue.tail + count)


def rounded_up(x: Array) -> Array:
    """A float32 that is not less."""
    return jnp.where(jnp.isfinite(x), x + jnp.abs(x) * 2.0**-22 + 2.0**-120, x).astype(jnp.float32)


@partial(jax.jit, static_argnames="width", donate_argnames="queue")
def pop(queue: Queue, corners: Array, neighbors: Array, width: int) -> tuple[Queue, Batch]:
    """Take at most ``width`` faces from a queue; those that have met in the meantime are dropped."""
    count = jnp.minimum(queue.tail - queue.head, width)
    # a slice that would go beyond the end begins earlier
    begin = jnp.minimum(queue.head, len(queue.half) - width)
    place = jnp.arange(width, dtype=jnp.int32) + begin - queue.head
    flags = (place >= 0) & (place < count)
    half = jnp.where(flags, jax.lax.dynamic_slice(queue.half, (begin,), (width,)), 0)
    flags &= at(neighbors, half) == OPEN
    if len(queue.bound) > 1:
        bound = jax.lax.dynamic_slice(queue.bound, (begin,), (width,)).astype(jnp.float64)
    else:
        bound = jnp.full(width, jnp.inf, jnp.float64)
    (half, bound), kept = packed(flags, half, bound)
    return queue._replace(head=queue.head + count), Batch(half, face_beyond(corners, half), bound, kept)


@partial(jax.jit, donate_argnames="queue")
def defer(queue: Queue, batch: Batch, expansion: Expansion, status: Array) -> Queue:
    """Put the faces of a batch that have a status into a queue, with their bounds."""
    flags = (jnp.arange(len(batch.half)) < batch.filled) & (expansion.status == status)
    return append(queue, flags, batch.half, rounded_up(expansion.high))


class Facts(NamedTuple):
    """What the host has to know after a step: integers."""

    tetrahedra: int
    fresh: int  # faces that wait to be tried
    tail: int  # of their queue
    contradictions: int
    unplaced: int  # facets that the table has no place for
    statuses: tuple[int, int, int, int]  # faces of each status


@partial(jax.jit, static_argnames="chunk", donate_argnames="mesh")
def attach(mesh: Mesh, batch: Batch, expansion: Expansion, chunk: int) -> tuple[Mesh, Array]:
    """Make the tetrahedra that a batch has found, each once; and the numbers of `facts_of`."""

    def one_chunk(start: Array, active: Array, state: tuple[Mesh, Array, Array]) -> tuple[Mesh, Array, Array]:
        mesh, contradictions, unplaced = state
        faces = batch.half, batch.face, expansion.status, expansion.site
        half, face, status, site = cut(faces, start, chunk)
        # a face may have met since it was taken: another of this batch has found its tetrahedron
        active = active & (at(mesh.neighbors, half) == OPEN)
        mesh, more, left = _attach_chunk(mesh, Outward(half, face, status, site, active))
        return mesh, contradictions + more, unplaced + left

    mesh, *faults = over_chunks(one_chunk, (mesh, jnp.int32(0), jnp.int32(0)), batch.filled, chunk)
    active = jnp.arange(len(batch.half)) < batch.filled
    statuses = [jnp.sum(active & (expansion.status == s), dtype=jnp.int32) for s in range(4)]
    fresh = mesh.fresh
    return mesh, jnp.stack([mesh.tetrahedra, fresh.tail - fresh.head, fresh.tail, *faults, *statuses])


def facts_of(numbers: Array) -> Facts:
    """The numbers of a step, on the host."""
    after, fresh, tail, contradictions, unplaced, *statuses = np.asarray(numbers).tolist()
    return Facts(after, fresh, tail, contradictions, unplaced, tuple(statuses))


class Outward(NamedTuple):
    """Faces of a chunk that have been expanded."""

    half: Array  # behind them
    face: Face[Array]
    status: Array
    site: Array
    active: Array  # whether there is one, and it is open


def _attach_chunk(mesh: Mesh, faces: Outward) -> tuple[Mesh, Array, Array]:
    corners, neighbors, table = mesh.corners, mesh.neighbors, mesh.table
    behind, face, status, site, active = faces
    width, capacity = len(behind), len(corners)
    index = jnp.arange(width, dtype=jnp.int32)
    found, hull = active & (status == FOUND), active & (status == HULL)

    # a face that is found stands in its place, so that others of its tetrahedron see it
    known = jnp.where(found | hull, behind, capacity)
    neighbors = neighbors.at[known].set(jnp.where(found, -3 - index, OUTSIDE), mode="drop")

    # one of the faces that found a tetrahedron makes it: the first
    (a, b, c), d = face, jnp.where(found, site, 0)
    facets = _others(a, b, c, d)
    entry, slot, unfound = look_up(table, corners, facets, jnp.tile(found, 3))
    there = entry != ABSENT
    state = at(neighbors, jnp.where(there, entry, 0))
    contradictions = jnp.sum(there & (state >= OUTSIDE), dtype=jnp.int32)
    earlier = there & (state <= -3) & (-3 - state < jnp.tile(index, 3))
    makes = found & ~jnp.any(earlier.reshape(3, width), axis=0)
    thirds = [*entry.reshape(3, width), *slot.reshape(3, width)]
    (a, b, c, d, behind, *thirds), m = packed(makes, a, b, c, d, behind, *thirds)
    entry, slot = jnp.concatenate(thirds[:3]), jnp.concatenate(thirds[3:])
    new = index < m
    news = jnp.tile(new, 3)

    # enter them, and those of their facets that nobody knew
    t = mesh.tetrahedra
    corners = jax.lax.dynamic_update_slice(corners, jnp.stack([a, b, c, d], axis=1).ravel(), (4 * t,))
    own = 4 * (t + index)
    half = jnp.concatenate([own, own + 1, own + 2])
    unknown = news & (entry == ABSENT)
    table, twin, unplaced = insert(table, corners, _others(a, b, c, d), half, slot, unknown)
    entry = jnp.where(unknown, twin, entry)

    # join neighbours
    met = news & (entry != ABSENT)
    mine = [*jnp.where(met, entry, OPEN).reshape(3, width), behind]
    neighbors = jax.lax.dynamic_update_slice(neighbors, jnp.stack(mine, axis=1).ravel(), (4 * t,))
    there = jnp.concatenate([jnp.where(met, entry, capacity), jnp.where(new, behind, capacity)])
    neighbors = neighbors.at[there].set(jnp.concatenate([half, own + 3]), mode="drop")

    fresh = append(mesh.fresh, news & (at(neighbors, half) == OPEN), half)
    return Mesh(corners, neighbors, table, fresh, t + m), contradictions, unfound + unplaced


def _others(a: Array, b: Array, c: Array, d: Array) -> Facet:
    """The facets of tetrahedra opposite a, then those opposite b, then those opposite c."""
    p, q, r = jnp.concatenate([b, a, a]), jnp.concatenate([c, c, b]), jnp.tile(d, 3)
    return ascending(p, q, r)


@partial(jax.jit, static_argnames=("slots", "width"))
def tabulate(
    corners: Array, neighbors: Array, tetrahedra: Array, slots: int, width: int
) -> tuple[Array, Array]:
    """A table of all open faces, and how many it has no place for."""

    def one_chunk(k: Array, state: tuple[Array, Array]) -> tuple[Array, Array]:
        table, unplaced = state
        begin = jnp.minimum(k * width, len(corners) - width)
        half = begin + jnp.arange(width, dtype=jnp.int32)
        is_open = (half >= k * width) & (half < 4 * tetrahedra)
        is_open &= jax.lax.dynamic_slice(neighbors, (begin,), (width,)) == OPEN
        facet = facet_of(corners, half)
        table, _, more = insert(table, corners, facet, half, first_slot(facet, slots), is_open)
        return table, unplaced + more

    start = jnp.full(slots, EMPTY_SLOT, jnp.int32), jnp.int32(0)
    chunks = (4 * tetrahedra + width - 1) // width
    filled: tuple[Array, Array] = jax.lax.fori_loop(0, chunks, one_chunk, start)
    return filled


def begun_with(tetrahedra: np.ndarray, capacity: int, width: int) -> Mesh:
    """A mesh of tetrahedra (m, 4) no two of which share a vertex."""
    m = len(tetrahedra)
    corners = np.zeros(4 * capacity, np.int32)
    corners[: 4 * m] = tetrahedra.ravel()
    neighbors = np.full(4 * capacity, OPEN, np.int32)
    fresh = np.zeros(4 * capacity, np.int32)
    fresh[: 4 * m] = np.arange(4 * m)
    zero = np.int32(0)
    queue = fresh, np.zeros(1, np.float32), zero, np.int32(4 * m)
    c, n, table = map(jnp.asarray, (corners, neighbors, zero))
    return with_table(Mesh(c, n, table, Queue(*map(jnp.asarray, queue)), jnp.int32(m)), width)


def empty_queue(capacity: int) -> Queue:
    """A queue that keeps bounds."""
    half, bound = jnp.zeros(capacity, jnp.int32), jnp.zeros(capacity, jnp.float32)
    return Queue(half, bound, jnp.int32(0), jnp.int32(0))


def with_table(mesh: Mesh, width: int) -> Mesh:
    """The mesh with a table of its open faces, and of no others.

    A tetrahedron enters at most three facets into it, those of a first one four.
    """
    slots = SLOTS_PER_TETRAHEDRON * len(mesh.corners) // 4
    table, unplaced = tabulate(mesh.corners, mesh.neighbors, mesh.tetrahedra, slots, width)
    check_places(int(unplaced), slots)
    on_device: Mesh = jax.tree.map(jnp.asarray, mesh._replace(table=table))
    return on_device


def check_places(unplaced: int, slots: int) -> None:
    """Raise InternalError where facets have looked at all slots of the table."""
    if unplaced:
        msg = f"{unplaced} facets have looked at all {slots} slots of their table"
        raise InternalError(msg)


def grown(mesh: Mesh, width: int) -> Mesh:
    """The mesh with twice the capacity."""
    mesh = mesh._replace(
        corners=_doubled(mesh.corners, 0),
        neighbors=_doubled(mesh.neighbors, OPEN),
        fresh=mesh.fresh._replace(half=_doubled(mesh.fresh.half, 0)),
    )
    return with_table(mesh, width)


def grown_queue(queue: Queue) -> Queue:
    """The queue with twice the capacity."""
    return queue._replace(half=_doubled(queue.half, 0), bound=_doubled(queue.bound, 0))


def _doubled(array: Array, value: int) -> Array:
    return jnp.concatenate([array, jnp.full(len(array), value, array.dtype)])

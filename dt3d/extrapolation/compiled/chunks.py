"""Loops over arrays of fixed capacity: chunks of a batch, and turns of a few elements."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import jax
import jax.numpy as jnp
from jax import Array

from ..faces import Face
from ..points import Point
from .stages import Batch, Expansion, nothing_known

UNROLLED = 4  # elements of one turn of a loop

S = TypeVar("S")  # the state of a loop


class Faces(NamedTuple):
    """The faces of a chunk of a batch."""

    face: Face[Array]
    bound: Array
    active: Array  # whether there is one


def at(array: Array, index: Array) -> Array:
    """Elements whose indices are known to exist."""
    return array.at[index].get(mode="promise_in_bounds")


def points_at(points: Point[Array], index: Array) -> Point[Array]:
    """The points whose indices are given."""
    return Point(*(at(x, index) for x in points))


def barrier(record: S) -> S:
    """The record, computed once for all that use it."""
    once: S = jax.lax.optimization_barrier(record)
    return once


def over_chunks(fn: Callable[[Array, Array, S], S], state: S, count: Array, chunk: int) -> S:
    """The state after ``fn(start, active, state)`` for every chunk of ``count`` elements."""

    def one_chunk(k: Array, state: S) -> S:
        start = k * chunk
        return fn(start, jnp.arange(chunk) + start < count, state)

    last: S = jax.lax.fori_loop(0, (count + chunk - 1) // chunk, one_chunk, state)
    return last


def expand_chunks(
    fn: Callable[[Faces], tuple[Expansion, Array]], batch: Batch, chunk: int
) -> tuple[Expansion, Array]:
    """The expansions of a batch and the number of sites examined, of ``fn`` for every chunk."""

    def one_chunk(start: Array, active: Array, state: tuple[Expansion, Array]) -> tuple[Expansion, Array]:
        out, searched = state
        face, bound = cut((batch.face, batch.bound), start, chunk)
        expansion, more = fn(Faces(face, bound, active))
        write = jax.lax.dynamic_update_slice
        return jax.tree.map(lambda x, y: write(x, y, (start,)), out, expansion), searched + more

    state = nothing_known(len(batch.face.a)), jnp.int64(0)
    return over_chunks(one_chunk, state, batch.filled, chunk)


def cut(record: S, start: Array, size: int) -> S:
    """A part of every array of a record."""
    part: S = jax.tree.map(lambda x: jax.lax.dynamic_slice(x, (start,), (size,)), record)
    return part


def unrolled(most: Array, body: Callable[[Array, S], S], start: S) -> S:
    """The body for 0, 1, ... up to ``most`` or a few more."""

    def turn(state: tuple[Array, S]) -> tuple[Array, S]:
        k, value = state
        for j in range(UNROLLED):
            value = body(k + j, value)
        return k + UNROLLED, value

    last: S = jax.lax.while_loop(lambda state: state[0] < most, turn, (jnp.int32(0), start))[1]
    return last

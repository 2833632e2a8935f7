"""Ties: faces for which the bounds leave several sites of a window, decided by integers.

Each face marks the sites that its bound leaves. Then all take one of theirs at a time: an orientation tells
whether it is above the face, an in-sphere test whether it beats the best so far. The symbolic perturbation
lets one of them beat all others.
"""

from __future__ import annotations

from functools import partial
from typing import TypeAlias

import jax
import jax.numpy as jnp
from jax import Array

from ...predicates.traced import one_case
from ..boxes import contains
from ..exact.expansion import cap_cells
from ..exact.filtered_distance import distance_bounds, frame
from ..faces import Face
from ..warrants import NO_SITE
from .chunks import Faces, at, expand_chunks, points_at, unrolled
from .stages import FOUND, HULL, WIDER, Batch, Expansion
from .tables import Digits, Tables
from .windows import window_around

WORDS = 4  # of 32 marks; windows with more members are left to others
MARKS = 32 * WORDS

Tournament: TypeAlias = tuple[tuple[Array, ...], Array]  # marks of those to come, and the best so far


@partial(jax.jit, static_argnames="chunk")
def expand_ties(tables: Tables, digits: Digits, batch: Batch, chunk: int) -> tuple[Expansion, Array]:
    """The outcome for the faces of a batch, `WIDER` where the window is not enough; and the sites examined.

    The window of a face is that about the cap below its bound.
    """
    return expand_chunks(partial(_decide, tables, digits), batch, chunk)


def _decide(tables: Tables, digits: Digits, faces: Faces) -> tuple[Expansion, Array]:
    points, windows, face = tables.points, tables.windows, faces.face
    a, b, c = (points_at(points, v) for v in face)
    query = frame(a, b, c, tables.lattice)
    window, box = window_around(cap_cells(query, faces.bound, windows.grid), windows)
    first = at(windows.starts, window)
    length = jnp.where(faces.active, at(windows.starts, window + 1) - first, 0)
    small = length <= MARKS
    length = jnp.where(small, length, 0)
    most = jnp.max(length)

    def bounds(k: Array) -> tuple[Array, Array]:
        site = at(windows.members, first + k)
        own = (site == face.a) | (site == face.b) | (site == face.c)
        low, high = distance_bounds(query, points_at(points, site))
        passed = own | (k >= length)
        return jnp.where(passed, jnp.inf, low), jnp.where(passed, jnp.inf, high)

    infinite = jnp.full_like(query.centre_error, jnp.inf)
    high = unrolled(most, lambda k, best: jnp.minimum(best, bounds(k)[1]), infinite)

    def mark(word: int) -> Array:
        def body(k: Array, marks: Array) -> Array:
            low, _ = bounds(32 * word + k)
            stays = (low < jnp.inf) & ~(low > high)
            return marks | jnp.where(stays, jnp.left_shift(jnp.uint32(1), k.astype(jnp.uint32)), 0)

        return unrolled(jnp.clip(most - 32 * word, 0, 32), body, jnp.zeros(len(first), jnp.uint32))

    def compare(state: Tournament) -> Tournament:
        marks, champion = state
        place, left, some = _next_mark(marks)
        challenger = at(windows.members, first + jnp.maximum(place, 0))
        return left, jnp.where(some & _wins(digits, face, champion, challenger), challenger, champion)

    def unfinished(state: Tournament) -> Array:
        return jnp.any(jnp.stack([m != 0 for m in state[0]]))

    # ends after at most `MARKS` turns: in each every face that is not finished loses a mark
    marks = tuple(mark(w) for w in range(WORDS))
    _, champion = jax.lax.while_loop(unfinished, compare, (marks, jnp.full_like(first, NO_SITE)))
    covered = contains(box, cap_cells(query, high, windows.grid)) & small
    status = jnp.where(covered, jnp.where(champion != NO_SITE, FOUND, HULL), WIDER).astype(jnp.int32)
    site = jnp.where(status == FOUND, champion, NO_SITE)
    expansion = Expansion(site, status, jnp.where(status == HULL, jnp.inf, -jnp.inf), high)
    return expansion, jnp.sum(length.astype(jnp.int64))


def _next_mark(marks: tuple[Array, ...]) -> tuple[Array, tuple[Array, ...], Array]:
    """The place of the lowest mark, -1 for none; the marks without it; and whether there was one."""
    place, left = jnp.full(len(marks[0]), -1, jnp.int32), []
    some = jnp.zeros(len(marks[0]), bool)
    for word, m in enumerate(marks):
        chosen = ~some & (m != 0)
        bit = m & (~m + 1)
        lowest = (31 - jax.lax.clz(bit)).astype(jnp.int32)
        place = jnp.where(chosen, 32 * word + lowest, place)
        left.append(jnp.where(chosen, m ^ bit, m))
        some |= chosen
    return place, tuple(left), some


def _wins(digits: Digits, face: Face[Array], champion: Array, challenger: Array) -> Array:
    """Whether a site is above the face, and inside the sphere of the best so far, if there is one."""
    a, b, c = (_digits_of(digits, v) for v in face)
    there = _digits_of(digits, challenger)
    above = jax.vmap(one_case.orient3d)(a, b, c, there) > 0
    some = champion != NO_SITE
    apex = jnp.where(some, champion, challenger)
    vertices = (a, b, c, _digits_of(digits, apex))
    ranks = tuple(at(digits.rank, v) for v in (*face, apex))
    inside = jax.vmap(one_case.inside)(vertices, ranks, there, at(digits.rank, challenger))
    wins: Array = above & (~some | inside)
    return wins


def _digits_of(digits: Digits, site: Array) -> tuple[tuple[Array, ...], ...]:
    """Of each of three coordinates its digits, as the predicates take them."""
    return tuple(tuple(at(row, site) for row in axis) for axis in digits.coordinates)

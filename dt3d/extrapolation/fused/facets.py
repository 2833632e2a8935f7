"""The table of facets: a hash table that finds the open face on the other side of a new one.

A slot holds a half-face, 4 t + k for the face of tetrahedron t opposite its k-th vertex; the facet's vertices
are read from the tetrahedron. All keys of a batch claim slots at once: each sends its half-face with a
minimum, reads the slot back, and goes on if another facet sits there. Facets that have met are never asked for
again and stay until the table is made anew.
"""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp

from ..dictionary import _hash as mixed
from .expand import at

EMPTY = 2**31 - 1
ABSENT = -1
SLOTS_PER_FACET = 2  # at least


def ascending(a: Any, b: Any, c: Any) -> tuple[Any, Any, Any]:
    """Three numbers in ascending order: the name of a facet."""
    low, high = jnp.minimum(a, b), jnp.maximum(a, b)
    return jnp.minimum(low, c), jnp.maximum(low, jnp.minimum(high, c)), jnp.maximum(high, c)


def facet_of(corners: Any, half: Any) -> tuple[Any, Any, Any]:
    """The name of the facet of a half-face."""
    first, k = half & ~3, half & 3
    return ascending(
        at(corners, first + (k == 0)), at(corners, first + 1 + (k <= 1)), at(corners, first + 2 + (k <= 2))
    )


def first_slot(facet: Any, slots: int) -> Any:
    return (mixed(facet) & jnp.uint32(slots - 1)).astype(jnp.int32)


def look_up(table: Any, corners: Any, facet: Any, active: Any) -> tuple[Any, Any]:
    """The half-face of each facet, or `ABSENT`; and the slot where the search ended."""
    slots = len(table)

    def turn(state: Any) -> Any:
        slot, found, searching = state
        entry = at(table, slot)
        taken = entry != EMPTY
        other = facet_of(corners, jnp.where(taken, entry, 0))
        same = taken
        for x, y in zip(facet, other, strict=True):
            same &= x == y
        same &= searching
        going = searching & taken & ~same
        return (
            jnp.where(going, (slot + 1) & (slots - 1), slot),
            jnp.where(same, entry, found),
            going,
        )

    slot = first_slot(facet, slots)
    state = slot, jnp.full_like(slot, ABSENT), active
    slot, found, _ = jax.lax.while_loop(lambda s: jnp.any(s[2]), turn, state)
    return found, slot


def insert(table: Any, corners: Any, facet: Any, half: Any, slot: Any, active: Any) -> tuple[Any, Any]:
    """Enter half-faces of facets that are not in the table, from the given slots on.

    Also the half-face that was there first, where two of the batch are of one facet, otherwise `ABSENT`.
    """
    slots = len(table)

    def turn(state: Any) -> Any:
        table, slot, twin, waiting = state
        free = waiting & (at(table, slot) == EMPTY)
        table = table.at[jnp.where(free, slot, slots)].min(half, mode="drop")
        entry = at(table, slot)
        mine = entry == half
        other = facet_of(corners, jnp.where(entry != EMPTY, entry, 0))
        same = waiting & ~mine
        for x, y in zip(facet, other, strict=True):
            same &= x == y
        waiting = waiting & ~mine & ~same
        return (
            table,
            jnp.where(waiting, (slot + 1) & (slots - 1), slot),
            jnp.where(same, entry, twin),
            waiting,
        )

    state = table, slot, jnp.full_like(half, ABSENT), active
    table, _, twin, _ = jax.lax.while_loop(lambda s: jnp.any(s[3]), turn, state)
    return table, twin

"""The table of facets: a hash table that finds the open face on the other side of a new one.

A slot holds a half-face, 4 t + k for the face of tetrahedron t opposite its k-th vertex; the facet's vertices
are read from the tetrahedron. All keys of a batch claim slots at once: each sends its half-face with a
minimum, reads the slot back, and goes on if another facet sits there. Facets that have met are never asked
for again and stay until the table is made anew.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import jax
import jax.numpy as jnp
from jax import Array

from ..dictionary import ABSENT, EMPTY_SLOT, hash32
from .chunks import S, at, barrier

Facet: TypeAlias = tuple[Array, Array, Array]  # vertices in ascending order

TURNS_OF_ALL = 2
MOST_TURNS = 2**31 - 1  # that 32 bits can count
ONE_IN = 8  # of those that wait goes on at a time,
TURNS_OF_FEW = 4  # so many turns


def ascending(a: Array, b: Array, c: Array) -> Facet:
    """Three numbers in ascending order: the name of a facet."""
    low, high = jnp.minimum(a, b), jnp.maximum(a, b)
    return jnp.minimum(low, c), jnp.maximum(low, jnp.minimum(high, c)), jnp.maximum(high, c)


def facet_of(corners: Array, half: Array) -> Facet:
    """The name of the facet of a half-face."""
    first, k = half & ~3, half & 3
    return ascending(
        at(corners, first + (k == 0)), at(corners, first + 1 + (k <= 1)), at(corners, first + 2 + (k <= 2))
    )


def first_slot(facet: Facet, slots: int) -> Array:
    """Where the search for a facet begins."""
    slot: Array = (hash32(facet) & jnp.uint32(slots - 1)).astype(jnp.int32)
    return slot


def look_up(table: Array, corners: Array, facet: Facet, active: Array) -> tuple[Array, Array, Array]:
    """The half-face of each facet, or `ABSENT`; the slot where the search ended; and how many did not end."""
    slots = len(table)

    def turn(shared: None, probe: Probe) -> tuple[None, Probe]:
        entry = barrier(at(table, probe.slot))
        taken = entry != EMPTY_SLOT
        same = barrier(taken & _names(probe.facet, corners, entry, taken))
        going = probe.waiting & taken & ~same
        slot = jnp.where(going, (probe.slot + 1) & (slots - 1), probe.slot)
        return shared, probe._replace(
            slot=slot, found=jnp.where(probe.waiting & same, entry, probe.found), waiting=going
        )

    slot = first_slot(facet, slots)
    probe = Probe(facet, slot, slot, jnp.full_like(slot, ABSENT), active)
    _, probe = _until_done(turn, None, probe, slots)
    return probe.found, probe.slot, _still_waiting(probe)


def insert(
    table: Array, corners: Array, facet: Facet, half: Array, slot: Array, active: Array
) -> tuple[Array, Array, Array]:
    """Enter half-faces of facets that are not in the table, from the given slots on.

    Also the half-face that was there first, where two of the batch are of one facet, otherwise `ABSENT`; and
    how many found no place.
    """
    slots = len(table)

    def turn(table: Array, probe: Probe) -> tuple[Array, Probe]:
        free = probe.waiting & (at(table, probe.slot) == EMPTY_SLOT)
        table = table.at[jnp.where(free, probe.slot, slots)].min(probe.half, mode="drop")
        entry = barrier(at(table, probe.slot))
        mine = entry == probe.half
        same = _names(probe.facet, corners, entry, entry != EMPTY_SLOT)
        same = barrier(same & probe.waiting & ~mine)
        going = probe.waiting & ~mine & ~same
        slot = jnp.where(going, (probe.slot + 1) & (slots - 1), probe.slot)
        return table, probe._replace(slot=slot, found=jnp.where(same, entry, probe.found), waiting=going)

    probe = Probe(facet, half, slot, jnp.full_like(half, ABSENT), active)
    table, probe = _until_done(turn, table, probe, slots)
    return table, probe.found, _still_waiting(probe)


def _still_waiting(probe: Probe) -> Array:
    return jnp.sum(probe.waiting, dtype=jnp.int32)


class Probe(NamedTuple):
    """Facets that look for their slots."""

    facet: Facet
    half: Array
    slot: Array  # where each is
    found: Array  # the half-face found, or `ABSENT`
    waiting: Array  # whether it goes on


def _names(facet: Facet, corners: Array, entry: Array, taken: Array) -> Array:
    other = facet_of(corners, jnp.where(taken, entry, 0))
    return (facet[0] == other[0]) & (facet[1] == other[1]) & (facet[2] == other[2])


def _until_done(
    turn: Callable[[S, Probe], tuple[S, Probe]], shared: S, probe: Probe, slots: int
) -> tuple[S, Probe]:
    """Turns of all, then of those that still wait, packed together: few wait for long.

    In every turn a facet is done or goes on to another slot, and the first few of those that wait take turns
    until they are done. So, as some slots are free, there are fewer turns than ``most``.
    """
    size = len(probe.slot)
    few = -(-size // ONE_IN)
    most = min((ONE_IN + 1) * (slots // TURNS_OF_FEW + 1), MOST_TURNS)
    for _ in range(TURNS_OF_ALL):
        shared, probe = turn(shared, probe)

    def again(state: tuple[Array, S, Probe]) -> tuple[Array, S, Probe]:
        turns, shared, probe = state
        place = jnp.cumsum(probe.waiting, dtype=jnp.int32)
        target = jnp.where(probe.waiting & (place <= few), place - 1, few)
        index = jnp.full(few, size, jnp.int32).at[target].set(jnp.arange(size, dtype=jnp.int32), mode="drop")
        there = jnp.minimum(index, size - 1)
        part = jax.tree.map(lambda x: at(x, there), probe)
        part = part._replace(waiting=part.waiting & (index < size))
        for _ in range(TURNS_OF_FEW):
            shared, part = turn(shared, part)
        return (
            turns + 1,
            shared,
            probe._replace(
                slot=probe.slot.at[index].set(part.slot, mode="drop"),
                found=probe.found.at[index].set(part.found, mode="drop"),
                waiting=probe.waiting.at[index].set(part.waiting, mode="drop"),
            ),
        )

    def unfinished(state: tuple[Array, S, Probe]) -> Array:
        turns, _, probe = state
        return jnp.any(probe.waiting) & (turns < most)

    _, shared, probe = jax.lax.while_loop(unfinished, again, (jnp.int32(0), shared, probe))
    return shared, probe

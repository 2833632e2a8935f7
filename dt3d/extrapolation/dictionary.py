"""Dictionaries in the vector model: hash tables filled by concurrent writes (Teng et al. 1993, section 5.2).

All keys of a batch claim slots at once: each sends its entry number to its slot with `MIN`, reads the slot
back, and goes on to the next slot if another key sits there. Equal keys meet in one slot, where the entry of
least number wins, so the outcome does not depend on the machine. A batch takes a few rounds, each over the
keys that are still without a slot.
"""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeAlias

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from .._errors import InternalError
from .points import T

EMPTY_SLOT = 2**31 - 1  # a slot without entry: loses against every claim
ABSENT = -1  # the entry number that a lookup gives for a key that is not there
Keys: TypeAlias = tuple[sv.Vector, ...]  # a record of int32 vectors
Key: TypeAlias = tuple[Array, ...]

FEWEST_SLOTS = 1024
SLOTS_PER_ENTRY = 2


class Dictionary(NamedTuple):
    """Entries 0, 1, ... and the table of slots that finds them by key."""

    table: sv.Vector  # int32 (slots,): entry number or EMPTY_SLOT; slots is a power of two
    keys: Keys  # of length (entries,)


class _Probe(NamedTuple, Generic[T]):
    """A key that is looking for its slot."""

    place: T  # its place in the batch
    key: tuple[T, ...]
    slot: T


def empty(machine: sv.Machine, width: int) -> Dictionary:
    """A dictionary whose keys are records (tuples) of ``width`` integers."""
    table = machine.full(FEWEST_SLOTS, EMPTY_SLOT, np.int32)
    return Dictionary(table, tuple(machine.full(0, 0, np.int32) for _ in range(width)))


def insert(dictionary: Dictionary, keys: Keys) -> tuple[Dictionary, sv.Vector]:
    """Add a batch of m keys; they become entries e, e+1, ..., e the number of entries before.

    Also returns, for each key, the entry that holds its slot: the key's own number if it is new, a smaller
    one if an equal key was there or comes earlier in the batch. A key that is not new leaves an entry unused.
    """
    machine = dictionary.table.machine
    first = len(dictionary.keys[0])
    m = len(keys[0])
    if not m:
        return dictionary, machine.full(0, ABSENT, np.int32)
    keys_now = sv.append(dictionary.keys, keys) if first else keys
    if SLOTS_PER_ENTRY * (first + m) > len(dictionary.table):
        # twice what is needed, so that the next batches fit; all entries are placed anew
        slots = _power_of_two(2 * SLOTS_PER_ENTRY * (first + m))
        table, holders = _claim(machine.full(slots, EMPTY_SLOT, np.int32), keys_now, keys_now, 0)
        new = machine.iota(m) + first
        return Dictionary(table, keys_now), sv.get(holders, new)
    table, holders = _claim(dictionary.table, keys_now, keys, first)
    return Dictionary(table, keys_now), holders


def look_up(dictionary: Dictionary, keys: Keys) -> sv.Vector:
    """The entry number of each of m keys, `ABSENT` where there is none; int32 (m,)."""
    machine = dictionary.table.machine
    m = len(keys[0])
    found = machine.full(m, ABSENT, np.int32)
    if not len(dictionary.keys[0]):
        return found
    slots = len(dictionary.table)
    probe = machine.map(_first_probe, machine.iota(m), keys, slots)
    turn = 0
    while len(probe.place):
        turn = _next_turn(turn, slots)
        entry = sv.get(dictionary.table, probe.slot)
        taken = entry != EMPTY_SLOT
        other = sv.get(dictionary.keys, entry, where=taken, otherwise=0)
        same = machine.map(_same, taken, probe.key, other)
        found = sv.scatter(entry, probe.place, into=found, where=same)
        probe = sv.pack(machine.map(_next_probe, probe, slots), machine.map(_walks_on, taken, same))
    return found


def _claim(table: sv.Vector, entries: Keys, keys: Keys, first: int) -> tuple[sv.Vector, sv.Vector]:
    machine, slots, m = table.machine, len(table), len(keys[0])
    holders = machine.full(m, ABSENT, np.int32)
    probe = machine.map(_first_probe, machine.iota(m), keys, slots)
    turn = 0
    while len(probe.place):
        turn = _next_turn(turn, slots)
        free = sv.get(table, probe.slot) == EMPTY_SLOT
        table = sv.send(probe.place + first, probe.slot, sv.MIN, into=table, where=free)
        entry = sv.get(table, probe.slot)
        same = machine.map(_equal, probe.key, sv.get(entries, entry))
        holders = sv.scatter(entry, probe.place, into=holders, where=same)
        probe = sv.pack(machine.map(_next_probe, probe, slots), ~same)
    return table, holders


def _next_turn(turn: int, slots: int) -> int:
    """In every turn a key comes to its slot or goes on to the next; at most half of them are taken."""
    if turn == slots:
        msg = f"a key has looked at all {slots} slots of its table"
        raise InternalError(msg)
    return turn + 1


def _power_of_two(n: int) -> int:
    return max(FEWEST_SLOTS, 1 << (n - 1).bit_length())


def hash32(key: Key) -> Array:
    """32 mixed bits of a tuple of int32 (multiply and shift after each word)."""
    h = jnp.uint32(0x9E3779B9)
    for word in jax.tree.leaves(key):
        h = (h ^ word.astype(jnp.uint32)) * jnp.uint32(0x85EBCA6B)
        h = (h ^ (h >> 15)) * jnp.uint32(0xC2B2AE35)
        h = h ^ (h >> 13)
    mixed: Array = h
    return mixed


def _first_probe(place: Array, key: Key, slots: Array) -> _Probe[Array]:
    slot = hash32(key) & (jnp.asarray(slots).astype(jnp.uint32) - 1)
    return _Probe(place, key, slot.astype(jnp.int32))


def _next_probe(probe: _Probe[Array], slots: Array) -> _Probe[Array]:
    return probe._replace(slot=(probe.slot + 1) & (slots - 1))


def _equal(key: Key, other: Key) -> Array:
    pairs = zip(jax.tree.leaves(key), jax.tree.leaves(other), strict=True)
    return jnp.all(jnp.stack([a == b for a, b in pairs]))


def _same(taken: Array, key: Key, other: Key) -> Array:
    return taken & _equal(key, other)


def _walks_on(taken: Array, same: Array) -> Array:
    return taken & ~same

"""The dead-face dictionary, and the consistency check that it makes possible.

Teng et al. 1993, section 5.2: every face of a triangulation has at most one tetrahedron on each side.
The dictionary holds one entry for each side of a facet that has been expanded, found by the facet's three
vertices in ascending order and the side. It finds new tetrahedra that contradict
earlier ones, purges open faces that have met, and holds the adjacency of the result.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

import scanvec as sv

from .._topology import OUTSIDE
from . import dictionary
from .dictionary import ABSENT, Dictionary
from .expansion import Face


class Tetrahedron(NamedTuple):
    """Vertices in positive orientation: det[b-a, c-a, d-a] > 0."""

    a: Any
    b: Any
    c: Any
    d: Any


class DeadFaces(NamedTuple):
    """Dead faces and the tetrahedron on the positive side of each, `OUTSIDE` for none."""

    dictionary: Dictionary
    tetrahedron: sv.Vector  # int32 (entries,)


def no_dead_faces(machine: sv.Machine) -> DeadFaces:
    return DeadFaces(dictionary.empty(machine, 4), machine.full(0, OUTSIDE, np.int32))


def face_of(t: Tetrahedron, k: Any) -> Face:
    """The face opposite the k-th vertex, with the tetrahedron on its positive side.

    (face, k-th vertex) is an even permutation of (a, b, c, d).
    """
    a = jnp.where(k == 0, t.c, jnp.where(k == 2, t.b, t.a))
    b = jnp.where(k == 0, t.b, jnp.where(k == 1, t.c, jnp.where(k == 2, t.a, t.b)))
    c = jnp.where(k == 3, t.c, t.d)
    return Face(a, b, c)


def opposite(f: Face) -> Face:
    """The same facet seen from the other side."""
    return Face(f.b, f.a, f.c)


def both_sides(facets: Face) -> Face:
    """Every facet seen from one side, then every one seen from the other."""
    return sv.append(facets, facets.a.machine.map(opposite, facets))


def face_key(f: Face) -> tuple[Any, Any, Any, Any]:
    """Vertices in ascending order, and the side: the parity of the permutation that sorts them."""
    low, mid, high, parity = f.a, f.b, f.c, jnp.zeros_like(f.a)
    for _ in range(2):
        low, mid, parity = _ordered(low, mid, parity)
        mid, high, parity = _ordered(mid, high, parity)
    return low, mid, high, parity


def _ordered(u: Any, v: Any, parity: Any) -> tuple[Any, Any, Any]:
    swap = u > v
    return jnp.where(swap, v, u), jnp.where(swap, u, v), parity ^ swap


def tetrahedron_key(t: Tetrahedron) -> tuple[Any, Any, Any, Any]:
    """Vertices in ascending order."""
    low, mid, high, _ = face_key(Face(t.a, t.b, t.c))
    low, d = jnp.minimum(low, t.d), jnp.maximum(low, t.d)
    mid, d = jnp.minimum(mid, d), jnp.maximum(mid, d)
    return low, mid, jnp.minimum(high, d), jnp.maximum(high, d)


def _faces(tetrahedra: Tetrahedron) -> tuple[Face, sv.Vector]:
    """The four faces of each tetrahedron, those of one tetrahedron together; and whose they are."""
    machine = tetrahedra.a.machine
    four = machine.full(len(tetrahedra.a), 4, np.int32)
    copies, segments = sv.distribute(tetrahedra, four)
    return machine.map(face_of, copies, segments.offsets), segments.ids


def distinct(tetrahedra: Tetrahedron) -> Tetrahedron:
    """One copy of each tetrahedron, whatever the order of its vertices."""
    machine = tetrahedra.a.machine
    keys = machine.map(tetrahedron_key, tetrahedra)
    _, holders = dictionary.insert(dictionary.empty(machine, 4), keys)
    return sv.pack(tetrahedra, holders == machine.iota(len(holders)))


def distinct_facets(facets: Face) -> Face:
    """One copy of each facet, whatever its side and the order of its vertices."""
    machine = facets.a.machine
    keys = machine.map(face_key, facets)[:3]
    _, holders = dictionary.insert(dictionary.empty(machine, 3), keys)
    return sv.pack(facets, holders == machine.iota(len(holders)))


def bury(dead: DeadFaces, tetrahedra: Tetrahedron, first: int) -> tuple[DeadFaces, Tetrahedron, int]:
    """Make the faces of new tetrahedra dead; those that contradict others are left out, and counted.

    ``first`` is the number of the first new tetrahedron. Of tetrahedra on one side of a face the first stays.
    """
    machine = dead.tetrahedron.machine
    lost = 0
    while True:  # at most as often as there are tetrahedra, each time with fewer
        faces, owner = _faces(tetrahedra)
        entries = len(dead.tetrahedron)
        filled, holders = dictionary.insert(dead.dictionary, machine.map(face_key, faces))
        beaten = holders != machine.iota(len(holders)) + entries
        refuted = sv.send(beaten, owner, sv.OR, into=machine.full(len(tetrahedra.a), False, bool))
        count = int(sv.reduce(refuted, sv.ADD))
        if not count:
            numbers = owner + first
            return DeadFaces(filled, sv.append(dead.tetrahedron, numbers)), tetrahedra, lost
        # vectors do not change: the dictionary without this batch is still at hand
        lost += count
        tetrahedra = sv.pack(tetrahedra, ~refuted)


def bury_boundary(dead: DeadFaces, faces: Face) -> tuple[DeadFaces, int]:
    """Make faces dead that have no site on their positive side; also how many had a tetrahedron there."""
    machine = dead.tetrahedron.machine
    entries = len(dead.tetrahedron)
    filled, holders = dictionary.insert(dead.dictionary, machine.map(face_key, faces))
    beaten = holders != machine.iota(len(holders)) + entries
    outside = machine.full(len(holders), OUTSIDE, np.int32)
    return DeadFaces(filled, sv.append(dead.tetrahedron, outside)), int(sv.reduce(beaten, sv.ADD))


def open_faces(dead: DeadFaces, tetrahedra: Tetrahedron) -> Face:
    """The outward faces of tetrahedra that are not dead."""
    machine = dead.tetrahedron.machine
    faces, _ = _faces(tetrahedra)
    outward = machine.map(opposite, faces)
    entry = dictionary.look_up(dead.dictionary, machine.map(face_key, outward))
    return sv.pack(outward, entry == ABSENT)


def neighbors(dead: DeadFaces, tetrahedra: Tetrahedron) -> tuple[sv.Vector, int]:
    """Of each tetrahedron the four neighbors, the k-th opposite the k-th vertex: int32 (4m,), row by row.

    Also the number of faces whose other side is not in the dictionary: holes that inconsistencies left.
    """
    machine = dead.tetrahedron.machine
    faces, _ = _faces(tetrahedra)
    entry = dictionary.look_up(dead.dictionary, machine.map(face_key, machine.map(opposite, faces)))
    known = entry != ABSENT
    number = sv.get(dead.tetrahedron, entry, where=known, otherwise=OUTSIDE)
    return number, int(sv.reduce(~known, sv.ADD))

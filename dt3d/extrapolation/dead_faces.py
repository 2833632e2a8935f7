"""The dead-face dictionary, and the consistency check that it makes possible.

Teng et al. 1993, section 5.2: every face of a triangulation has at most one tetrahedron on each side.
The dictionary holds one entry for each side of a facet that has been expanded, found by the facet's three
vertices in ascending order and the side. It finds new tetrahedra that contradict
earlier ones, purges open faces that have met, and holds the adjacency of the result.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import scanvec as sv

from .._topology import OUTSIDE
from . import dictionary
from .dictionary import ABSENT, Dictionary
from .faces import Face, Tetrahedron, face_key, faces_of, opposite, tetrahedron_key


class DeadFaces(NamedTuple):
    """Dead faces and the tetrahedron on the positive side of each, `OUTSIDE` for none."""

    dictionary: Dictionary
    tetrahedron: sv.Vector  # int32 (entries,)


def no_dead_faces(machine: sv.Machine) -> DeadFaces:
    """An empty dictionary of dead faces."""
    return DeadFaces(dictionary.empty(machine, 4), machine.full(0, OUTSIDE, np.int32))


def distinct(tetrahedra: Tetrahedron[sv.Vector]) -> Tetrahedron[sv.Vector]:
    """One copy of each tetrahedron, whatever the order of its vertices."""
    machine = tetrahedra.a.machine
    keys = machine.map(tetrahedron_key, tetrahedra)
    _, holders = dictionary.insert(dictionary.empty(machine, 4), keys)
    first: Tetrahedron[sv.Vector] = sv.pack(tetrahedra, holders == machine.iota(len(holders)))
    return first


def distinct_facets(facets: Face[sv.Vector]) -> Face[sv.Vector]:
    """One copy of each facet, whatever its side and the order of its vertices."""
    machine = facets.a.machine
    keys = machine.map(face_key, facets)[:3]
    _, holders = dictionary.insert(dictionary.empty(machine, 3), keys)
    first: Face[sv.Vector] = sv.pack(facets, holders == machine.iota(len(holders)))
    return first


def insert_dead_faces(
    dead: DeadFaces, tetrahedra: Tetrahedron[sv.Vector], first: int
) -> tuple[DeadFaces, Tetrahedron[sv.Vector], int]:
    """Make the faces of new tetrahedra dead; those that contradict others are left out, and counted.

    ``first`` is the number of the first new tetrahedron. Of tetrahedra on one side of a face the first stays.
    """
    machine = dead.tetrahedron.machine
    rejected = 0
    while True:  # at most as often as there are tetrahedra, each time with fewer
        faces, owner = faces_of(tetrahedra)
        entries = len(dead.tetrahedron)
        filled, holders = dictionary.insert(dead.dictionary, machine.map(face_key, faces))
        taken = holders != machine.iota(len(holders)) + entries
        contradicts = sv.send(taken, owner, sv.OR, into=machine.full(len(tetrahedra.a), False, bool))
        count = int(sv.reduce(contradicts, sv.ADD))
        if not count:
            numbers = owner + first
            return DeadFaces(filled, sv.append(dead.tetrahedron, numbers)), tetrahedra, rejected
        # vectors do not change: the dictionary without this batch is still at hand
        rejected += count
        tetrahedra = sv.pack(tetrahedra, ~contradicts)


def insert_boundary_faces(dead: DeadFaces, faces: Face[sv.Vector]) -> tuple[DeadFaces, int]:
    """Make faces dead that have no site on their positive side; also how many had a tetrahedron there."""
    machine = dead.tetrahedron.machine
    entries = len(dead.tetrahedron)
    filled, holders = dictionary.insert(dead.dictionary, machine.map(face_key, faces))
    taken = holders != machine.iota(len(holders)) + entries
    outside = machine.full(len(holders), OUTSIDE, np.int32)
    return DeadFaces(filled, sv.append(dead.tetrahedron, outside)), int(sv.reduce(taken, sv.ADD))


def open_faces(dead: DeadFaces, tetrahedra: Tetrahedron[sv.Vector]) -> Face[sv.Vector]:
    """The outward faces of tetrahedra that are not dead."""
    machine = dead.tetrahedron.machine
    faces, _ = faces_of(tetrahedra)
    outward: Face[sv.Vector] = machine.map(opposite, faces)
    entry = dictionary.look_up(dead.dictionary, machine.map(face_key, outward))
    still_open: Face[sv.Vector] = sv.pack(outward, entry == ABSENT)
    return still_open


def neighbors(dead: DeadFaces, tetrahedra: Tetrahedron[sv.Vector]) -> tuple[sv.Vector, int]:
    """Of each tetrahedron the four neighbors, the k-th opposite the k-th vertex: int32 (4m,), row by row.

    Also the number of faces whose other side is not in the dictionary: holes that inconsistencies left.
    """
    machine = dead.tetrahedron.machine
    faces, _ = faces_of(tetrahedra)
    entry = dictionary.look_up(dead.dictionary, machine.map(face_key, machine.map(opposite, faces)))
    known = entry != ABSENT
    number = sv.get(dead.tetrahedron, entry, where=known, otherwise=OUTSIDE)
    return number, int(sv.reduce(~known, sv.ADD))

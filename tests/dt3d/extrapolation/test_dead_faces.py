"""Dead faces: contradictions, and what is open."""

import itertools

import numpy as np
import pytest

import scanvec as sv
from dt3d.extrapolation.dead_faces import (
    distinct,
    insert_boundary_faces,
    insert_dead_faces,
    no_dead_faces,
    open_faces,
)
from dt3d.extrapolation.faces import Face, Tetrahedron

MACHINES = (sv.Device(), sv.Simulated(processors=3))


def vectors(machine, rows, width):
    array = np.array(rows, np.int32).reshape(-1, width)
    return tuple(machine.vector(c.copy()) for c in array.T)


def tetrahedra(machine, rows):
    return Tetrahedron(*vectors(machine, rows, 4))


def as_rows(record):
    return np.stack([v.to_numpy() for v in record], axis=1).tolist()


def test_each_tetrahedron_is_kept_once():
    machine = MACHINES[0]
    rows = [*itertools.permutations([3, 1, 8, 5]), [1, 3, 5, 9], [9, 5, 3, 1], [3, 1, 8, 5]]
    assert as_rows(distinct(tetrahedra(machine, rows))) == [[3, 1, 8, 5], [1, 3, 5, 9]]


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_of_two_tetrahedra_on_one_side_of_a_face_the_first_stays(machine):
    dead = no_dead_faces(machine)
    # the second has the first's face (0, 1, 2) with its own fourth vertex on the same side
    dead, kept, lost = insert_dead_faces(
        dead, tetrahedra(machine, [[0, 1, 2, 3], [0, 1, 2, 4], [5, 6, 7, 8]]), 0
    )
    assert as_rows(kept) == [[0, 1, 2, 3], [5, 6, 7, 8]]
    assert lost == 1
    # also against an earlier batch; a neighbour on the other side is no contradiction
    dead, kept, lost = insert_dead_faces(dead, tetrahedra(machine, [[2, 0, 1, 9], [1, 0, 2, 9]]), 2)
    assert as_rows(kept) == [[1, 0, 2, 9]]
    assert lost == 1
    dead, lost = insert_boundary_faces(dead, Face(*vectors(machine, [[0, 1, 2], [30, 31, 32]], 3)))
    assert lost == 1


def test_outward_faces_are_open_unless_dead():
    machine = MACHINES[0]
    both = tetrahedra(machine, [[0, 1, 2, 3], [1, 0, 2, 9]])  # they share the face 0 1 2
    dead, kept, _ = insert_dead_faces(no_dead_faces(machine), both, 0)
    opened = {frozenset(f) for f in as_rows(open_faces(dead, kept))}
    assert opened == {
        frozenset(f) for f in [(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 2, 9), (1, 2, 9), (0, 1, 9)]
    }

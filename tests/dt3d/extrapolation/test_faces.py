"""Faces and their keys: orientation, sides."""

import numpy as np
import pytest

from dt3d.extrapolation.faces import Face, Tetrahedron, face_key, face_of, opposite


@pytest.mark.parametrize("k", range(4))
def test_a_face_and_its_opposite_vertex_keep_the_orientation(k):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    t = Tetrahedron(*(np.int32(i) for i in range(4)))
    a, b, c = corners[[int(i) for i in face_of(t, np.int32(k))]]
    assert np.linalg.det([b - a, c - a, corners[k] - a]) > 0


def test_keys_tell_the_sides_apart_and_nothing_else():
    side = {tuple(map(int, face_key(Face(*map(np.int32, p))))) for p in [(4, 7, 9), (7, 9, 4), (9, 4, 7)]}
    other = {tuple(map(int, face_key(Face(*map(np.int32, p))))) for p in [(4, 9, 7), (9, 7, 4), (7, 4, 9)]}
    assert side == {(4, 7, 9, 0)}
    assert other == {(4, 7, 9, 1)}
    f = Face(*map(np.int32, (4, 7, 9)))
    assert tuple(map(int, face_key(opposite(f)))) == (4, 7, 9, 1)

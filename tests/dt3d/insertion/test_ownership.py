"""Parts of the cyclic order of sites."""

import numpy as np
import pytest

from dt3d.insertion.mesh import INFINITE, bundle
from dt3d.insertion.ownership import Part, owns, owns_all, owns_some


@pytest.mark.parametrize(
    "part", [Part(0, 10, 10), Part(0, 4, 10), Part(7, 6, 10), Part(9, 1, 10), Part(3, 7, 10)]
)
def test_a_part_is_an_interval_of_a_circle(part):
    inside = {(part.first + i) % part.sites for i in range(part.length)}
    assert {v for v in range(part.sites) if owns(part, v)} == inside


def test_tetrahedra_are_owned_by_their_finite_vertices():
    rng = np.random.default_rng(0)
    part = Part(6, 7, 10)
    corners = rng.integers(0, 10, (200, 4)).astype(np.uint32)
    corners[::3, 1] = INFINITE
    corners[:2] = [6, 9, 2, INFINITE], [3, 4, 5, INFINITE]
    tetrahedra = np.concatenate([corners, np.zeros_like(corners)], axis=1).ravel()
    mesh = bundle(np.zeros(40), tetrahedra, np.zeros(800))
    for t, row in enumerate(corners.tolist()):
        owned = [owns(part, v) for v in row if v != INFINITE]
        assert owns_all(mesh, t, part) == all(owned)
        assert owns_some(mesh, t, part) == any(owned)
    assert owns_all(mesh, 0, part)
    assert not owns_some(mesh, 1, part)

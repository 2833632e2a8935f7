"""Lattices are seen, and magnitudes that floating point has no room for."""

import numpy as np
import pytest

import dt3d

from ...exact import validate
from ...families import grid
from .modes import MACHINE, SETS, exact_sites, lexicographic


def test_lattices_are_seen():
    assert exact_sites(lexicographic(SETS["lattice"])).lattice
    assert exact_sites(lexicographic(grid(5) * 2.0**-70)).lattice
    assert exact_sites(lexicographic(SETS["far"])).lattice
    assert not exact_sites(lexicographic(SETS["tenths"])).lattice
    assert not exact_sites(lexicographic(grid(3) * [2.0**17, 1, 1])).lattice


@pytest.mark.parametrize("factor", [2.0**-210, 2.0**-1070])
def test_sites_too_close_for_floating_point_are_an_error_that_says_so(factor):
    points = SETS["uniform"] * np.repeat([1, factor], 30)[:, None]
    with pytest.raises(ValueError, match=r"at least 2\^-200 of the greatest .* method='insertion'"):
        dt3d.Delaunay(points, machine=MACHINE)
    validate(dt3d.Delaunay(points))

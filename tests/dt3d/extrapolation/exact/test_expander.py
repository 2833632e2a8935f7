"""The exact mode finds what insertion does."""

import numpy as np
import pytest

import dt3d

from ...exact import validate
from ...families import tetrahedra
from .modes import SETS


@pytest.mark.parametrize("name", SETS)
def test_equals_insertion(name):
    tri = dt3d.Delaunay(SETS[name], method="extrapolation")
    validate(tri)
    want = dt3d.Delaunay(SETS[name], method="insertion")
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))
    assert tri.stats.exact_decisions <= tri.stats.face_expansions
    if name == "uniform":
        assert tri.stats.exact_decisions == 0

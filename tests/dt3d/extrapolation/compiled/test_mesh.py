"""The mesh, where its table has too few slots."""

import jax
import numpy as np
import pytest

import dt3d
from dt3d.extrapolation.compiled import mesh


def test_more_facets_than_the_table_has_slots(monkeypatch):
    tetrahedra = np.arange(160, dtype=np.int32).reshape(40, 4)
    with jax.enable_x64(True):
        mesh.begun_with(tetrahedra, 64, 32)
        monkeypatch.setattr(mesh, "SLOTS_PER_TETRAHEDRON", 1)
        with pytest.raises(dt3d.InternalError, match="96 facets have looked at all 64 slots"):
            mesh.begun_with(tetrahedra, 64, 32)

"""The search of caps settles every face of a set without ties."""

import jax
import numpy as np

from dt3d.extrapolation.compiled.cap_search import expand_in_caps
from dt3d.extrapolation.compiled.stages import FOUND, HULL
from dt3d.extrapolation.warrants import NO_SITE

from .steps import outward_faces, random_set


def test_all_faces_are_settled():
    with jax.enable_x64(True):
        cells, batch, want = outward_faces(random_set(600), 300)
        expansion, searched = expand_in_caps(cells.tables, batch, cells.layout.cap_chunk)
        site, status = (np.asarray(x)[: len(want)] for x in expansion[:2])
    np.testing.assert_array_equal(site, want)
    np.testing.assert_array_equal(status, np.where(want == NO_SITE, HULL, FOUND))
    assert int(searched) > len(want)

"""A face that its window settles has the right fourth vertex."""

import jax
import numpy as np

from dt3d.extrapolation.compiled.stages import FOUND, HULL, WIDER
from dt3d.extrapolation.compiled.window_search import expand_in_windows
from dt3d.extrapolation.warrants import NO_SITE

from .steps import outward_faces, random_set


def test_what_is_settled_is_right():
    with jax.enable_x64(True):
        cells, batch, want = outward_faces(random_set(600), 300)
        expansion, searched = expand_in_windows(cells.tables, batch, cells.layout.chunk)
        site, status = (np.asarray(x)[: len(want)] for x in expansion[:2])
    np.testing.assert_array_equal(site[status == FOUND], want[status == FOUND])
    assert (want[status == HULL] == NO_SITE).all()
    assert set(status.tolist()) <= {FOUND, HULL, WIDER}
    assert (status == FOUND).sum() > 50
    assert int(searched) > len(want)

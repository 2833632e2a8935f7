"""What the filters leave open, without the filters: all stages decide by themselves."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

from dt3d import InternalError
from dt3d.predicates import open_stages, plane, space, work_array
from dt3d.predicates.workspace import scaled

from .oracle import DIMENSION, POINTS, sign

finite = st.floats(allow_nan=False, allow_infinity=False)
small = st.integers(-3, 3).map(float)


@given(hnp.arrays(np.float64, (5, 3), elements=finite | small))
def test_each_stage_alone_is_right_about_all_points(points):
    for predicate, k in POINTS.items():
        d = DIMENSION[predicate]
        case = scaled(np.ascontiguousarray(points[:k, :d]))
        origin = case[0] if predicate.startswith("orient") else case[-1]
        with np.errstate(over="ignore"):
            extents = tuple(np.abs(case - origin).max(axis=0).tolist())
        if not np.isfinite(extents).all() or max(extents) > 2.0**200:
            continue  # the filter passes on what is beyond all doubles with an infinite slack
        # the rounded determinant only counts on a lattice, where it is exact
        det = float(sign(predicate, case))
        stage = getattr(open_stages, f"{predicate}_open")
        corners = tuple(tuple(corner) for corner in case.tolist())
        assert stage(corners, det, extents, work_array(case)) == sign(predicate, case)


def test_the_workspace_has_the_stages_of_its_dimension():
    flat, solid = np.eye(4, 2), np.eye(5, 3)
    assert plane.orient2d(flat, 2, 2, 3, work_array(flat)) == 0
    assert space.orient3d(solid, 3, 4, 0, 1, work_array(solid)) == 0
    with pytest.raises(InternalError, match="no address"):
        space.orient3d(solid, 3, 4, 0, 1, work_array(flat))

"""The exact stage alone, for any finite coordinates."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from dt3d.predicates import big_integers, work_array

from .oracle import DIMENSION, POINTS, sign

finite = st.floats(allow_nan=False, allow_infinity=False)


@given(hnp.arrays(np.float64, (5, 3), elements=finite | st.integers(-3, 3).map(float)))
def test_the_exact_stage_alone(points):
    for predicate, k in POINTS.items():
        case = np.ascontiguousarray(points[:k, : DIMENSION[predicate]])
        corners = [tuple(corner) for corner in case.tolist()]
        got = getattr(big_integers, f"{predicate}_exact")(*corners, work_array(case))
        assert got == sign(predicate, case)

"""What the compiled predicates know of the points."""

from fractions import Fraction

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from dt3d.predicates import scaled, work_array
from dt3d.predicates.layout import SLACK_INDEX

finite = st.floats(allow_nan=False, allow_infinity=False)


@given(hnp.arrays(np.float64, (3, 3), elements=finite))
def test_scaling_loses_nothing(points):
    got = scaled(points)
    greatest = np.abs(points).max()
    if greatest > 0 and np.abs(points[points != 0]).min() >= greatest * 2.0**-1020:
        assert 0.5 <= np.abs(got).max() < 1
    assert (got != 0).sum() == (points != 0).sum()
    ratios = {Fraction(a) / Fraction(b) for a, b in zip(got.ravel(), points.ravel(), strict=True) if b}
    assert len(ratios) <= 1


def test_nothing_is_decided_in_floating_point_that_could_overflow():
    assert work_array(np.array([[1e300, 1.0]]))[SLACK_INDEX] == np.inf
    assert work_array(np.array([[0.5, -1.0]]))[SLACK_INDEX] == 2.0**-1000
    assert 2.0**-1000 < work_array(np.array([[0.5, -1e6]]))[SLACK_INDEX] < 2.0**-890

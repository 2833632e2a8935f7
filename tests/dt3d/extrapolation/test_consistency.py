"""A run that cannot end is given up."""

import pytest

import dt3d
from dt3d.extrapolation import consistency
from dt3d.extrapolation.outcome import Outcome


def test_more_tetrahedra_than_any_triangulation_has():
    consistency.check_progress(Outcome(per_iteration=[50]), 10, True)
    too_many = Outcome(per_iteration=[50, 1])
    with pytest.raises(dt3d.InternalError, match="51 tetrahedra of 10 sites were found"):
        consistency.check_progress(too_many, 10, True)
    with pytest.raises(dt3d.InconsistencyError, match="Use method='insertion'"):
        consistency.check_progress(too_many, 10, False)

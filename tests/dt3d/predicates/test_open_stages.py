"""What the filters leave open, without the filters: all stages decide by themselves."""

import subprocess
import sys

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from dt3d.predicates import open_stages, work_array
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


GENERAL = """
import numpy as np, dt3d
from dt3d.predicates.layout import FINDER, INTEGERS_INDEX, SLACK_INDEX
from dt3d.predicates import work_array

def known():
    words = work_array(np.zeros((1, 3))).view(np.int64)[SLACK_INDEX + 1 : INTEGERS_INDEX]
    return int((words != 0).sum())

points = np.random.default_rng(0).random((500, 3))
begun = known()
for d in (2, 3):
    tri = dt3d.Delaunay(points[:, :d])
    tri.find_simplex(np.random.default_rng(1).random((100, d)))
    assert tri.verify()
print(begun, known())
tri.find_simplex(points)
print(known())
"""


def test_only_what_is_asked_for_is_compiled():
    done = subprocess.run([sys.executable, "-c", GENERAL], capture_output=True, text=True, check=True)
    # what finds the others; what ghosts need; and, for points that are vertices, an orientation
    assert done.stdout.split() == ["1", "2", "3"]

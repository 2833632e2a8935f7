"""What is known of the least score among some sites."""

import hypothesis.strategies as st
import numpy as np
from hypothesis import given

import scanvec as sv
from dt3d.extrapolation.warrants import LEAST_BOUNDS, NO_SITE, Best, least, nothing_found

MACHINE = sv.Device()
bounds = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=1, max_size=9)


@given(bounds)
def test_the_two_least_lower_bounds_and_the_least_upper_one(pairs):
    rows = [(min(p), max(p)) for p in pairs]
    best = Best(np.inf, NO_SITE, np.inf, np.inf)
    for site, (low, high) in enumerate(rows):
        best = least(best, Best(np.float32(low), site, np.float32(np.inf), np.float32(high)))
    lows = sorted(low for low, _ in rows)
    assert float(best.low) == lows[0]
    assert float(best.second) == (lows[1] if len(lows) > 1 else np.inf)
    assert float(best.high) == min(high for _, high in rows)
    assert rows[int(best.site)][0] == lows[0]


def test_the_best_of_no_sites_is_neutral():
    found = Best(*(MACHINE.vector(np.array([x], t)) for x, t in ((2, "f8"), (7, "i4"), (3, "f8"), (4, "f8"))))
    both = sv.append(nothing_found(MACHINE, 1, np.float64), found)
    segments = sv.Segments.from_lengths(MACHINE.vector(np.array([2], np.int32)))
    assert [v.to_numpy().tolist() for v in sv.reduce(both, LEAST_BOUNDS, segments)] == [[2], [7], [3], [4]]

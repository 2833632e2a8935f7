"""`scipy.spatial.voronoi_plot_2d` on our diagrams."""

import numpy as np
import pytest
import scipy.spatial

import dt3d

pyplot = pytest.importorskip("matplotlib.pyplot")

# those of SciPy's test_gh_19653
NARROW = [
    [245.059986986012, 10.971011721360075],
    [320.49044143557785, 10.970258360366753],
    [239.79023081978914, 13.108487516946218],
    [263.38325791238833, 12.93241352743668],
    [219.53334398353175, 13.346107628161008],
]


@pytest.mark.parametrize(
    "points", [NARROW, np.random.default_rng(0).random((50, 2))], ids=["narrow", "random"]
)
def test_the_same_segments_as_for_scipys(points):
    segments = []
    for made in (dt3d.Voronoi, scipy.spatial.Voronoi):
        figure = scipy.spatial.voronoi_plot_2d(made(np.array(points)))
        found = [np.array(part.get_segments()) for part in figure.gca().collections]
        pyplot.close(figure)
        # segments in an order of their own, and those without direction by their least end
        found = [np.array([s if tuple(s[0]) <= tuple(s[1]) else s[::-1] for s in part]) for part in found]
        segments.append([part[np.lexsort(part.reshape(len(part), -1).round(6).T)] for part in found])
    for ours, theirs in zip(*segments, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-9)

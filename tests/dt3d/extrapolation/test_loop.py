"""The main loop: the iteration of a tetrahedron is its depth (Teng et al. 1993, section 3)."""

import numpy as np

import dt3d
import scanvec as sv


def test_the_iteration_is_the_distance_from_the_first_facets():
    points = np.random.default_rng(0).random((120, 3))
    tri = dt3d.Delaunay(points, robustness="perturb", machine=sv.Device())
    near = np.where(tri.neighbors < 0, np.iinfo(np.int32).max, tri.iteration[tri.neighbors]).min(axis=1)
    later = tri.iteration > 1
    np.testing.assert_array_equal(near[later], tri.iteration[later] - 1)
    assert tri.stats.iterations - 1 <= tri.iteration.max() <= tri.stats.iterations

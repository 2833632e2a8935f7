"""Where the triangulation begins."""

import numpy as np

from dt3d.extrapolation.compiled.first_tetrahedra import (
    chosen_sites,
    without_common_vertices,
    wrapped_facets,
)
from dt3d.extrapolation.compiled.windows import grid_of, windows_of

from .steps import random_set


def test_facets_are_wrapped_about_the_nearest_site():
    sites = random_set(500)
    windows = windows_of(sites, grid_of(sites, 1.33), 512)
    chosen = chosen_sites(len(sites) * 40)
    chosen = chosen[chosen < len(sites)]
    facets = wrapped_facets(sites, windows, chosen)
    a, b, c = facets.T
    squared = ((sites[a][:, None] - sites) ** 2).sum(axis=2)
    squared[np.arange(len(a)), a] = np.inf
    assert (squared.argmin(axis=1) == b).mean() > 0.8  # a window does not have all neighbours
    assert ((a != c) & (b != c)).all()


def test_tetrahedra_share_no_vertex():
    rows = np.array([[0, 1, 2, 3], [3, 4, 5, 6], [4, 5, 6, 7], [8, 9, 10, 11]])
    assert without_common_vertices(rows, 12).tolist() == [[0, 1, 2, 3], [8, 9, 10, 11]]

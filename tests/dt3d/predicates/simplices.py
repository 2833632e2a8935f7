"""Lattices, whose simplices have many ties."""

import numpy as np

from dt3d.predicates import orient2d, orient3d


def simplices(d, side, count, seed=0):
    """A lattice in lexicographic order, and positive simplices of it with one more site, int (m, d + 2)."""
    axes = np.meshgrid(*[np.arange(side)] * d, indexing="ij")
    points = np.stack(axes, -1).reshape(-1, d).astype(float)
    rng = np.random.default_rng(seed)
    rows = np.array([rng.choice(len(points), d + 2, replace=False) for _ in range(count)])
    sign = [orient2d, orient3d][d - 2](*(points[rows[:, k]] for k in range(d + 1)))
    rows[sign < 0, :2] = rows[sign < 0, 1::-1]
    return points, rows[sign != 0]

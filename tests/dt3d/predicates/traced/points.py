"""Points as tuples of coordinates, and these as tuples of digits."""

import numpy as np


def as_points(limbs, rows, vector):
    """The digits (L, n, 3) of the sites in rows (m, k), as k points of vectors."""
    return tuple(
        tuple(tuple(vector(np.ascontiguousarray(x[rows[:, k], c])) for x in limbs) for c in range(3))
        for k in range(rows.shape[1])
    )

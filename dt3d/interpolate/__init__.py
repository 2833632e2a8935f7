"""Interpolation of scattered data in triangulations, in the plane and in space.

>>> import numpy as np
>>> from dt3d.interpolate import Linear
>>> points = np.random.default_rng(0).random((100, 3))
>>> f = Linear(points, points @ [1, 2, 3])
>>> f([[0.5, 0.5, 0.5]]).round(12).tolist(), f(9, 9, 9).tolist()
([3.0], nan)
"""

from .linear import Linear
from .natural_neighbor import NaturalNeighbor
from .nearest import Nearest

__all__ = ["Linear", "NaturalNeighbor", "Nearest"]

"""dt3d: Delaunay triangulations in parallel, and how they come about.

>>> import numpy as np, dt3d
>>> tri = dt3d.Delaunay(np.random.default_rng(0).random((100, 3)))
>>> tri.simplices.shape[1], tri.simplices.dtype
(4, dtype('int32'))
"""

from ._errors import (
    DegenerateInputError,
    InconsistencyError,
    InconsistencyWarning,
    InternalError,
    QuadraticSearchWarning,
)
from ._stats import InsertionStatistics, Progress, Statistics
from ._topology import OUTSIDE
from .delaunay import Delaunay

__version__ = "0.1.0"

__all__ = [
    "OUTSIDE",
    "DegenerateInputError",
    "Delaunay",
    "InconsistencyError",
    "InconsistencyWarning",
    "InsertionStatistics",
    "InternalError",
    "Progress",
    "QuadraticSearchWarning",
    "Statistics",
    "__version__",
]

"""Delaunay triangulation in the plane by threads on shared memory (Kohout, Kolingerova, Zara 2004)."""

from .._errors import DegenerateInputError
from .delaunay import Delaunay
from .statistics import Statistics
from .verification import verify

__all__ = ["DegenerateInputError", "Delaunay", "Statistics", "verify"]

"""Delaunay triangulation in the plane by several threads on shared memory (Kohout, Kolingerova, Zara 2004)."""

from .delaunay import Delaunay
from .statistics import Statistics

__all__ = ["Delaunay", "Statistics"]

"""Voronoi diagrams in the plane and in space, of exact triangulations: `dt3d.Voronoi`."""

from .clipped import Cell, Clipped
from .diagram import Voronoi

__all__ = ["Cell", "Clipped", "Voronoi"]

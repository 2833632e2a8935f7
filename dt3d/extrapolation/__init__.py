"""Parallel incremental extrapolation in 3D, written on scanvec.

Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo: A Data-parallel Algorithm for Three-dimensional Delaunay
Triangulation and its Implementation. Supercomputing '93, pages 112-121.
"""

from .loop import Outcome, triangulate
from .perturbation import normalise, perturb

__all__ = ["Outcome", "normalise", "perturb", "triangulate"]

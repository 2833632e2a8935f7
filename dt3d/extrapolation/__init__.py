"""Parallel incremental extrapolation in 3D, written on scanvec; README.md here says what is where.

Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo: A Data-parallel Algorithm for Three-dimensional Delaunay
Triangulation and its Implementation. Supercomputing '93, pages 112-121.
"""

from .expansion import Perturbed
from .loop import extrapolate
from .outcome import Outcome
from .perturbation import normalise, perturb
from .search_options import PAPER_SEARCH, SearchOptions
from .triangulation import triangulate

__all__ = [
    "PAPER_SEARCH", "Outcome", "Perturbed", "SearchOptions", "extrapolate", "normalise", "perturb",
    "triangulate",
]  # fmt: skip

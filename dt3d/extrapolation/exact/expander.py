"""The exact mode of the main loop: checked first facets, then exact expansions."""

from __future__ import annotations

import numpy as np

import scanvec as sv

from ..buckets import Buckets
from ..faces import Face
from ..outcome import Counts
from .decisions import expand_exactly
from .first_facets import checked_facets
from .sites import ExactSites


class Exact:
    """Expands faces of sites as they are, which come in lexicographic order."""

    exact = True

    def __init__(self, buckets: Buckets, sites: np.ndarray) -> None:
        self._sites = ExactSites(buckets, sites)

    def begin(self, facets: Face[sv.Vector]) -> tuple[Face[sv.Vector], sv.Vector, Counts]:
        """The first open faces and their fourth vertices."""
        first, counts = checked_facets(self._sites, facets)
        return first.faces, first.site, counts

    def expand(self, faces: Face[sv.Vector]) -> tuple[sv.Vector, Counts]:
        """The fourth vertex of each face, or `NO_SITE`."""
        expansion, counts = expand_exactly(self._sites, faces)
        return expansion.site, counts

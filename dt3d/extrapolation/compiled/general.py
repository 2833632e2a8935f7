"""What is left to the general code: faces that no step settles, and first facets where all are ties.

It has buckets of its own, made when they are needed, and so its own numbers of the sites.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

import scanvec as sv

from ...predicates.traced.digits import limbs_of
from ..buckets import bucket
from ..dead_faces import distinct_facets
from ..exact.decisions import expand_exactly
from ..exact.first_facets import seeds as exact_seeds
from ..exact.sites import ExactSites, small_integers
from ..expansion import Face
from ..gift_wrapping import first_facets
from ..points import Point
from ..warrants import NO_SITE


class GeneralCode:
    """Of sites (n, 3) in lexicographic order, which are numbered here by ``order``."""

    def __init__(self, machine: sv.Machine, sites: np.ndarray, order: np.ndarray) -> None:
        self._machine, self._sites, self._order = machine, sites, order

    @cached_property
    def lattice(self) -> bool:
        """Whether heights are exact in floating point."""
        return small_integers(limbs_of(self._sites))

    @cached_property
    def exact(self) -> ExactSites:
        columns = (self._machine.vector(np.ascontiguousarray(c)) for c in self._sites.T)
        return ExactSites(bucket(Point(*columns)), self._sites)

    @cached_property
    def _theirs(self) -> tuple[np.ndarray, np.ndarray]:
        origin = self.exact.buckets.origin.to_numpy()
        there = np.empty(len(origin), np.int32)
        there[origin] = np.arange(len(origin))
        here = np.empty(len(origin), np.int32)
        here[self._order] = np.arange(len(origin))
        return there[self._order], here[origin]

    def expand(self, faces: np.ndarray) -> tuple[np.ndarray, int]:
        """Fourth vertices, or `NO_SITE`, of faces (m, 3); and the sites examined."""
        there, here = self._theirs
        vectors = (self._machine.vector(np.ascontiguousarray(there[v])) for v in faces.T)
        expansion, counts = expand_exactly(self.exact, Face(*vectors))
        site = expansion.site.to_numpy()
        return np.where(site == NO_SITE, NO_SITE, here[site]).astype(np.int32), counts.sites_searched

    def seeds(self, chosen: np.ndarray) -> np.ndarray:
        """Tetrahedra (m, 4) at first facets of chosen sites, or of all if those have none."""
        there = self._machine.vector(self._theirs[0][chosen])
        facets = Face(*first_facets(self.exact.buckets, there))
        facets = sv.pack(facets, facets.c != NO_SITE)
        if not len(facets.a):
            facets = Face(*first_facets(self.exact.buckets))
            facets = sv.pack(facets, facets.c != NO_SITE)
        start, _ = exact_seeds(self.exact, distinct_facets(facets))
        rows = np.stack([v.to_numpy() for v in (*start.faces, start.site)], axis=1)
        return self._theirs[1][rows[rows[:, 3] != NO_SITE]]

"""What is left to the vectors: faces that no step settles, and first facets where all are ties.

Vectors number the sites along a Morton curve of coarse cells, the steps row by row of fine cells. One
numbering does not serve both: the tree takes eight consecutive sites for a box, which rows would make long
and thin, and the steps take the sites of a part of a row as one range. So faces are translated here.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

import scanvec as sv

from ..buckets import bucket
from ..dead_faces import distinct_facets
from ..exact.decisions import expand_exactly
from ..exact.first_facets import checked_facets
from ..exact.sites import ExactSites
from ..faces import Face
from ..gift_wrapping import first_facets
from ..points import Point
from ..warrants import NO_SITE


class VectorProgram:
    """The exact mode on vectors, of sites (n, 3) in lexicographic order that ``order`` numbers here."""

    def __init__(self, machine: sv.Machine, sites: np.ndarray, order: np.ndarray) -> None:
        self._machine, self._sites, self._order = machine, sites, order

    @cached_property
    def exact(self) -> ExactSites:
        """Buckets and integers, made when they are needed."""
        columns = (self._machine.vector(np.ascontiguousarray(c)) for c in self._sites.T)
        return ExactSites(bucket(Point(*columns)), self._sites)

    @cached_property
    def _numbers(self) -> tuple[np.ndarray, np.ndarray]:
        """Numbers on the curve of sites in rows, and numbers in rows of sites on the curve."""
        origin = self.exact.buckets.origin.to_numpy()
        on_curve = np.empty(len(origin), np.int32)
        on_curve[origin] = np.arange(len(origin))
        in_rows = np.empty(len(origin), np.int32)
        in_rows[self._order] = np.arange(len(origin))
        return on_curve[self._order], in_rows[origin]

    def expand(self, faces: np.ndarray) -> tuple[np.ndarray, int]:
        """Fourth vertices, or `NO_SITE`, of faces (m, 3); and the sites examined."""
        on_curve, in_rows = self._numbers
        vectors = (self._machine.vector(np.ascontiguousarray(on_curve[v])) for v in faces.T)
        expansion, counts = expand_exactly(self.exact, Face(*vectors))
        site = expansion.site.to_numpy()
        return np.where(site == NO_SITE, NO_SITE, in_rows[site]).astype(np.int32), counts.sites_searched

    def first_tetrahedra(self, chosen: np.ndarray) -> np.ndarray:
        """Tetrahedra (m, 4) at first facets of chosen sites, or of all if those have none."""
        on_curve, in_rows = self._numbers
        facets = Face(*first_facets(self.exact.buckets, self._machine.vector(on_curve[chosen])))
        facets = sv.pack(facets, facets.c != NO_SITE)
        if not len(facets.a):
            facets = Face(*first_facets(self.exact.buckets))
            facets = sv.pack(facets, facets.c != NO_SITE)
        first, _ = checked_facets(self.exact, distinct_facets(facets))
        rows = np.stack([v.to_numpy() for v in (*first.faces, first.site)], axis=1)
        tetrahedra: np.ndarray = in_rows[rows[rows[:, 3] != NO_SITE]]
        return tetrahedra

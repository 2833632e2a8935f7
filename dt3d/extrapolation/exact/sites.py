"""The sites as exact integers, and exact decisions about many of them at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from jax import Array

import scanvec as sv

from ...predicates.layout import DIGIT_BITS
from ...predicates.traced import one_case
from ...predicates.traced.digits import limbs_of
from ..buckets import Buckets
from ..faces import Face

# With differences of so many bits the height of a site above a face, a sum of six products of three, is
# exact.
LATTICE_BITS = 16
# The least difference of two coordinates, in units of the greatest, with which no product of the filter
# underflows: the fourth power, times 2^-53 for what cancels in a normal, is a normal number.
LEAST_DIFFERENCE = 2.0**-200


def check_magnitudes(coordinates: np.ndarray) -> None:
    """Raise ValueError where products of the filter would under- or overflow."""
    with np.errstate(over="ignore"):
        gaps = [np.diff(np.unique(x)) for x in coordinates.T]
    least = min(float(g.min(initial=np.inf)) for g in gaps)
    if float(np.abs(coordinates).max()) > 1 or least < LEAST_DIFFERENCE:
        msg = (
            "extrapolation takes coordinates whose least difference is at least 2^-200 of the greatest one; "
            "these are closer. Use method='insertion', without a machine, which takes any"
        )
        raise ValueError(msg)


def are_small_integers(limbs: np.ndarray) -> bool:
    """Whether coordinates, digits (L, n, 3), are small integers times one power of two, up to an offset."""
    if len(limbs) > 2:
        return False
    values = sum(x.astype(np.int64) << (DIGIT_BITS * k) for k, x in enumerate(limbs))
    return bool((np.ptp(values, axis=0) < 2**LATTICE_BITS).all())


Digits: TypeAlias = tuple[tuple[Array, ...], ...]  # of each of three coordinates


@dataclass(frozen=True)
class ExactSites:
    """What exact decisions need of the sites of some buckets.

    Attributes
    ----------
    buckets : Buckets
    coordinates : ndarray of float64 (n, 3)
        In lexicographic order, which is that of the symbolic perturbation.
    """

    buckets: Buckets
    coordinates: np.ndarray

    @cached_property
    def _limbs(self) -> np.ndarray:
        return limbs_of(self.coordinates)

    @cached_property
    def lattice(self) -> bool:
        """Whether all coordinates are small integers times one power of two, up to an offset."""
        return are_small_integers(self._limbs)

    @cached_property
    def digits(self) -> tuple[tuple[sv.Vector, ...], ...]:
        """Of each of three coordinates its digits, vectors of length n."""
        machine = self.buckets.machine
        axes = tuple(
            tuple(machine.vector(np.ascontiguousarray(x[:, axis])) for x in self._limbs) for axis in range(3)
        )
        digits: tuple[tuple[sv.Vector, ...], ...] = sv.get(axes, self.buckets.origin)
        return digits

    @property
    def rank(self) -> sv.Vector:
        """Each site's place in the lexicographic order."""
        return self.buckets.origin

    def orientation(self, face: Face[sv.Vector], site: sv.Vector) -> sv.Vector:
        """Signs of det[b-a, c-a, d-a], int32 (m,), of m faces (a, b, c) and sites d."""
        points = (sv.get(self.digits, v) for v in (*face, site))
        signs: sv.Vector = site.machine.map(one_case.orient3d, *points)
        return signs

    def inside(self, face: Face[sv.Vector], apex: sv.Vector, site: sv.Vector) -> sv.Vector:
        """Whether sites are inside the perturbed circumspheres of m positive tetrahedra (a, b, c, apex)."""
        named = (*face, apex, site)
        points = (sv.get(self.digits, v) for v in named)
        ranks = (sv.get(self.rank, v) for v in named)
        inside: sv.Vector = site.machine.map(_inside, *points, *ranks)
        return inside


def _inside(a: Digits, b: Digits, c: Digits, d: Digits, e: Digits, *ranks: Array) -> Array:
    inside: Array = one_case.inside((a, b, c, d), ranks[:4], e, ranks[4])
    return inside

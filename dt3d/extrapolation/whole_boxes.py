"""The paper's own boxes: all cells of the circumsphere's containment box, none left out.

Teng et al. 1993, section 4.2. A search begins with the containment box of the face and its circumcentre, and
goes on towards the containment box of the circumsphere of the face and the best site so far, as far as that
is in the box of "unit cube and Hp". It ends when either box is within the dead box.

The paper does not say how a box is "extended in the directions where the gaps are large". README.md here has
the readings that were tried, and what each gives beside Table 1.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from . import signed_distance
from .boxes import Box, Grid, containment_box, intersection
from .caps import Plane, cell_margin, half_space_bounds
from .expansion import PERTURBED, PerturbedFace
from .points import Point
from .warrants import SearchSpec

CLOSING = 36  # cells: so few are opened in one round, whatever the gaps


def _half_space(query: PerturbedFace, grid: Grid[Array]) -> Box[Array]:
    """The cells of "unit cube and Hp"."""
    f = query.frame
    zero = jnp.zeros_like(f.height_error)
    low, high = half_space_bounds(Plane(f.origin, f.normal, Point(zero, zero, zero)), grid.origin, grid.high)
    rounding = cell_margin(grid)
    return containment_box(Point(*(v - rounding for v in low)), Point(*(v + rounding for v in high)), grid)


def _sphere(query: PerturbedFace, distance: Array, grid: Grid[Array]) -> Box[Array]:
    """Line "newbox := containment_box(circumsphere((a, b, c, d)))"."""
    centre, squared = signed_distance.circumsphere(query.frame, distance)
    radius = jnp.sqrt(squared) + cell_margin(grid)
    low = Point(*(v - radius for v in centre))
    high = Point(*(v + radius for v in centre))
    return containment_box(low, high, grid)


def _region(query: PerturbedFace, distance: Array, grid: Grid[Array]) -> Box[Array]:
    """The box of the best site's circumsphere within that of the half-space; without a site the latter."""
    found = jnp.isfinite(distance)
    half_space = _half_space(query, grid)
    sphere = _sphere(query, jnp.where(found, distance, 0), grid)
    both = intersection(sphere, half_space)
    return Box(*(jnp.where(found, s, h) for s, h in zip(both, half_space, strict=True)))


def _always(query: PerturbedFace, bound: Array, low: Point[Array], high: Point[Array]) -> Array:
    return jnp.full(jnp.shape(bound), True)


WHOLE_BOXES: SearchSpec[PerturbedFace] = SearchSpec(
    PERTURBED.score, PERTURBED.start_sites, _region, _always, PERTURBED.trial_bound, closing=CLOSING
)

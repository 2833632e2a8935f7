"""Face expansion for sites as they are: signed distances are known between bounds only."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp

from ..boxes import Box, Grid
from ..caps import cap_box
from ..expansion import Face, OpenFace, homes, trial
from ..points import Point, epsilon, norm
from ..warrants import Question
from . import filtered_distance


def open_exact_face(face: Face, a: Point, b: Point, c: Point, lattice: Any) -> OpenFace:
    return OpenFace(filtered_distance.frame(a, b, c, lattice), face)


def _bounds(query: OpenFace, site: Point, index: Any) -> tuple[Any, Any]:
    own = (index == query.face.a) | (index == query.face.b) | (index == query.face.c)
    low, high = filtered_distance.distance_bounds(query.frame, site)
    return jnp.where(own, jnp.inf, low), jnp.where(own, jnp.inf, high)


def cap_cells(f: filtered_distance.Frame, bound: Any, grid: Grid) -> Box:
    """All cells that could hold a site above a face whose signed distance is at most ``bound``."""
    # what the errors of centre and normal can move, and the roundings of the cap itself
    reach = norm(f.centre) + jnp.abs(bound) * norm(f.normal)
    slack = 4 * (f.blur + jnp.abs(bound) * norm(f.doubt)) + 64 * epsilon(f.blur) * reach
    return cap_box(f.origin, f.normal, f.doubt, f.centre, bound / 2, slack, grid)


def _region(query: OpenFace, bound: Any, grid: Grid) -> Box:
    return cap_cells(query.frame, bound, grid)


def _may_hold(query: OpenFace, bound: Any, low: Point, high: Point) -> Any:
    return filtered_distance.may_hold(query.frame, bound, low, high)


def trial_bound(f: filtered_distance.Frame, k: Any) -> Any:
    """The k-th bound to try; inf from `TRIALS` on."""
    return trial(f.centre, k, norm(f.normal) / 2)


def _exact_trial(query: OpenFace, k: Any) -> Any:
    return trial_bound(query.frame, k)


FILTERED = Question(_bounds, homes, _region, _may_hold, _exact_trial)

"""Face expansion for sites as they are: signed distances are known between bounds only."""

from __future__ import annotations

from typing import TypeAlias

import jax.numpy as jnp
from jax import Array

from ..boxes import Box, Grid
from ..caps import Plane, cap_box
from ..expansion import OpenFace, trial_distance, vertices
from ..faces import Face
from ..points import Point, epsilon, norm
from ..warrants import SearchSpec
from . import filtered_distance
from .filtered_distance import Frame

ExactFace: TypeAlias = OpenFace[Frame, Array]


def open_face(
    face: Face[Array], a: Point[Array], b: Point[Array], c: Point[Array], lattice: Array | bool
) -> ExactFace:
    """The query of a face; ``lattice`` says that heights are exact, for small integers."""
    return OpenFace(filtered_distance.frame(a, b, c, lattice), face)


def _bounds(query: ExactFace, site: Point[Array], index: Array) -> tuple[Array, Array]:
    own = (index == query.face.a) | (index == query.face.b) | (index == query.face.c)
    low, high = filtered_distance.distance_bounds(query.frame, site)
    return jnp.where(own, jnp.inf, low), jnp.where(own, jnp.inf, high)


def plane_of(f: Frame) -> Plane:
    """The plane of a face, with what is known of it."""
    return Plane(f.origin, f.normal, f.normal_error)


def cap_error(f: Frame, bound: Array, size: Array) -> Array:
    """What the errors of centre and normal can move a cap, and the roundings of the cap itself.

    Parameters
    ----------
    f : Frame
        Of the face.
    bound : Array
        Of the absolute value of the signed distance.
    size : Array
        At least the radius.
    """
    return 4 * (f.centre_error + bound * norm(f.normal_error)) + 64 * epsilon(f.centre_error) * size


def cap_cells(f: Frame, bound: Array, grid: Grid[Array]) -> Box[Array]:
    """All cells that could hold a site above a face whose signed distance is at most ``bound``."""
    size = norm(f.centre) + jnp.abs(bound) * norm(f.normal)
    return cap_box(plane_of(f), f.centre, bound / 2, cap_error(f, jnp.abs(bound), size), grid)


def _region(query: ExactFace, bound: Array, grid: Grid[Array]) -> Box[Array]:
    return cap_cells(query.frame, bound, grid)


def _may_contain(query: ExactFace, bound: Array, low: Point[Array], high: Point[Array]) -> Array:
    return filtered_distance.may_contain(query.frame, bound, low, high)


def trial_bound(f: Frame, k: Array) -> Array:
    """The k-th bound to try; inf from `TRIALS` on."""
    return trial_distance(f.centre, k, norm(f.normal) / 2)


def _trial_bound(query: ExactFace, k: Array) -> Array:
    return trial_bound(query.frame, k)


FILTERED: SearchSpec[ExactFace] = SearchSpec(_bounds, vertices, _region, _may_contain, _trial_bound)

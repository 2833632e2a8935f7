"""Face expansion: the site on a face's positive side that forms a Delaunay tetrahedron with it.

Teng et al. 1993, section 4. The search is Algorithm Face Expansion, in `cell_requests.py`; what is particular
to faces is here. `PERTURBED` is the paper's: sites are in general position, and their signed distances are
compared as they come. `exact/expansion.py` has the form for sites as they are.
"""

from __future__ import annotations

from typing import Generic, NamedTuple, Protocol, TypeAlias, TypeVar

import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from . import signed_distance
from .boxes import Box, Grid
from .buckets import Buckets
from .caps import Plane, cap_box
from .faces import Face, both_sides
from .gift_wrapping import squared_distance_to_box
from .outcome import Counts, counted
from .points import Point, T, add, bounding_box, dot, epsilon, norm, sub, total
from .search import search
from .warrants import Q, SearchResult, SearchSpec

# Bounds that a tree search tries before it does without.
TRIALS = 4


class Expander(Protocol):
    """Expands faces, in one of the modes."""

    exact: bool  # whether contradictions cannot be

    def begin(self, facets: Face[sv.Vector]) -> tuple[Face[sv.Vector], sv.Vector, Counts]:
        """The first open faces and their fourth vertices."""

    def expand(self, faces: Face[sv.Vector]) -> tuple[sv.Vector, Counts]:
        """The fourth vertex of each face, or `NO_SITE`."""


class SomeFrame(Protocol):
    """What both forms of a frame have."""

    @property
    def origin(self) -> Point[Array]:
        """A vertex of the face."""

    @property
    def centre(self) -> Point[Array]:
        """Of the face's circumcircle, relative to the origin."""


F = TypeVar("F", bound=SomeFrame)


class OpenFace(NamedTuple, Generic[F, T]):
    """An open face as a query: its frame and its vertices."""

    frame: F
    face: Face[T]


def first_box(
    query: OpenFace[F, Array], a: Point[Array], b: Point[Array], c: Point[Array], most: Array
) -> tuple[Point[Array], Point[Array]]:
    """The corners of the box of a face and its circumcentre, which may be ``most`` beyond it.

    Faces of slivers at the hull have circumcentres far away; opening all cells on the way would be in vain.
    """
    low, high = bounding_box(a, b, c)
    centre = add(query.frame.origin, query.frame.centre)
    low = Point(*(jnp.minimum(u, jnp.maximum(v, u - most)) for u, v in zip(low, centre, strict=True)))
    high = Point(*(jnp.maximum(u, jnp.minimum(v, u + most)) for u, v in zip(high, centre, strict=True)))
    return low, high


def search_faces(
    buckets: Buckets, queries: object, corners: list[Point[sv.Vector]], spec: SearchSpec[Q]
) -> SearchResult:
    """The best sites of open faces, which have the given corners, three records of coordinates."""
    first = (corners[0], corners[0])
    if buckets.cells is not None:
        # "newbox := containment_box({a, b, c, o_circ})"
        side = buckets.cells.grid.side
        most = side.dtype.type(np.inf) if buckets.options.whole_boxes else side
        first = buckets.machine.map(first_box, queries, *corners, most)
    return search(buckets, queries, first, spec)


def vertices(query: OpenFace[F, Array]) -> tuple[Array, Array, Array]:
    """The face's vertices, near which its search starts."""
    return query.face.a, query.face.b, query.face.c


def trial_distance(centre: Point[Array], k: Array, unit: Array | float) -> Array:
    """The k-th bound to try: half the radius of the face's circumcircle, then 2, 8, 32 of them, then inf."""
    distance = norm(centre) * jnp.left_shift(1, 2 * k) / 2
    return jnp.where(k < TRIALS, distance / unit, jnp.inf)


PerturbedFace: TypeAlias = OpenFace[signed_distance.Frame, Array]


def open_face(face: Face[Array], a: Point[Array], b: Point[Array], c: Point[Array]) -> PerturbedFace:
    """The query of a face of perturbed sites."""
    return OpenFace(signed_distance.frame(a, b, c), face)


def _score(query: PerturbedFace, site: Point[Array], index: Array) -> tuple[Array, Array]:
    distance = signed_distance.signed_distance(query.frame, site)
    return distance, distance


def _region(query: PerturbedFace, distance: Array, grid: Grid[Array]) -> Box[Array]:
    f = query.frame
    zero = jnp.zeros_like(f.height_error)
    return cap_box(Plane(f.origin, f.normal, Point(zero, zero, zero)), f.centre, distance, zero, grid)


def _may_contain(query: PerturbedFace, distance: Array, low: Point[Array], high: Point[Array]) -> Array:
    """Whether a box meets the positive half-space and, once there is a candidate, its circumsphere."""
    face = query.frame
    lo, hi = sub(low, face.origin), sub(high, face.origin)
    height = total(jnp.maximum(m * u, m * v) for m, u, v in zip(face.normal, lo, hi, strict=True))
    found = jnp.isfinite(distance)
    centre, squared = signed_distance.circumsphere(face, jnp.where(found, distance, 0))
    # the squares lose what the coordinates have beyond an ulp of the radius
    error = 64 * epsilon(low.x) * (squared + dot(centre, centre))
    meets = squared_distance_to_box(centre, low, high) <= squared + error
    return (height >= 0) & (meets | ~found)


def _trial_bound(query: PerturbedFace, k: Array) -> Array:
    return trial_distance(query.frame.centre, k, 1)


PERTURBED: SearchSpec[PerturbedFace] = SearchSpec(_score, vertices, _region, _may_contain, _trial_bound)


def expand_perturbed(
    buckets: Buckets, faces: Face[sv.Vector], spec: SearchSpec[PerturbedFace] = PERTURBED
) -> SearchResult:
    """The fourth vertex of each face, or `NO_SITE` where no site is on its positive side."""
    corners = [sv.get(buckets.sites, v) for v in faces]
    queries = buckets.machine.map(open_face, faces, *corners)
    return search_faces(buckets, queries, corners, spec)


class Perturbed:
    """Expands faces of perturbed sites, as in the paper."""

    exact = False

    def __init__(self, buckets: Buckets, spec: SearchSpec[PerturbedFace] = PERTURBED) -> None:
        self._buckets, self._spec = buckets, spec

    def begin(self, facets: Face[sv.Vector]) -> tuple[Face[sv.Vector], sv.Vector, Counts]:
        """The first open faces and their fourth vertices."""
        faces = both_sides(facets)
        return faces, *self.expand(faces)

    def expand(self, faces: Face[sv.Vector]) -> tuple[sv.Vector, Counts]:
        """The fourth vertex of each face, or `NO_SITE`."""
        result = expand_perturbed(self._buckets, faces, self._spec)
        return result.best.site, counted(len(faces.a), result)

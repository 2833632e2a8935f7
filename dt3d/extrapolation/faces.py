"""Facets, faces and tetrahedra as tuples of site numbers: the terms of Teng et al. 1993, section 2.4.

* A *site* is an input point; all simplices hold numbers of sites.
* A *facet* is a triangle, a *face* a facet with an orientation. The positive half-space Hp of a face
  (a, b, c) is the side of (b-a) x (c-a).
* A tetrahedron is on the positive side of its four faces, the k-th of which is opposite its k-th vertex.
"""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from .points import T

Key: TypeAlias = tuple[Array, Array, Array, Array]


class Face(NamedTuple, Generic[T]):
    """Sites a, b, c; the positive half-space is on the side of (b-a) x (c-a)."""

    a: T
    b: T
    c: T


class Tetrahedron(NamedTuple, Generic[T]):
    """Vertices in positive orientation: det[b-a, c-a, d-a] > 0."""

    a: T
    b: T
    c: T
    d: T


def face_of(t: Tetrahedron[Array], k: Array) -> Face[Array]:
    """The face opposite the k-th vertex, with the tetrahedron on its positive side.

    (face, k-th vertex) is an even permutation of (a, b, c, d).
    """
    a = jnp.where(k == 0, t.c, jnp.where(k == 2, t.b, t.a))
    b = jnp.where(k == 0, t.b, jnp.where(k == 1, t.c, jnp.where(k == 2, t.a, t.b)))
    c = jnp.where(k == 3, t.c, t.d)
    return Face(a, b, c)


def faces_of(tetrahedra: Tetrahedron[sv.Vector]) -> tuple[Face[sv.Vector], sv.Vector]:
    """The four faces of each tetrahedron, those of one tetrahedron together; and whose they are."""
    machine = tetrahedra.a.machine
    four = machine.full(len(tetrahedra.a), 4, np.int32)
    copies, segments = sv.distribute(tetrahedra, four)
    faces: Face[sv.Vector] = machine.map(face_of, copies, segments.offsets)
    return faces, segments.ids


def opposite(f: Face[T]) -> Face[T]:
    """The same facet seen from the other side."""
    return Face(f.b, f.a, f.c)


def both_sides(facets: Face[sv.Vector]) -> Face[sv.Vector]:
    """Every facet seen from one side, then every one seen from the other."""
    faces: Face[sv.Vector] = sv.append(facets, facets.a.machine.map(opposite, facets))
    return faces


def face_key(f: Face[Array]) -> Key:
    """Vertices in ascending order, and the side: the parity of the permutation that sorts them."""
    low, mid, high, parity = f.a, f.b, f.c, jnp.zeros_like(f.a)
    for _ in range(2):
        low, mid, parity = _ordered(low, mid, parity)
        mid, high, parity = _ordered(mid, high, parity)
    return low, mid, high, parity


def _ordered(u: Array, v: Array, parity: Array) -> tuple[Array, Array, Array]:
    swap = u > v
    return jnp.where(swap, v, u), jnp.where(swap, u, v), parity ^ swap


def tetrahedron_key(t: Tetrahedron[Array]) -> Key:
    """Vertices in ascending order."""
    low, mid, high, _ = face_key(Face(t.a, t.b, t.c))
    low, d = jnp.minimum(low, t.d), jnp.maximum(low, t.d)
    mid, d = jnp.minimum(mid, d), jnp.maximum(mid, d)
    return low, mid, jnp.minimum(high, d), jnp.maximum(high, d)

"""The predicates in JAX on arrays of cases: exact signs, int32 (n,), of int32 (L, k, d, n).

These are L digits, as in `digits`, of the d coordinates of k points in n cases. Sign conventions are those
of `plane` and `space`. Minors are computed together, so that a predicate has few products of whole
arrays.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import jax
import jax.numpy as jnp

from .digits import carry, product, sign

# Rows of the minors of four rows: without the first, the second, ..., and all pairs.
_OTHERS = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))
_PAIRS = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))


def orient2d(x: jax.Array) -> jax.Array:
    """Signs of det[b-a, c-a] of three points."""
    return sign(_minors(x[:, 1:] - x[:, :1], [(0, 1)])[:, 0])


def orient3d(x: jax.Array) -> jax.Array:
    """Signs of det[b-a, c-a, d-a] of four points."""
    r = x[:, 1:] - x[:, :1]
    minors = _minors(r, [(1, 2), (2, 0), (0, 1)])
    terms = product(r[:, :, 2], minors)
    return sign(carry(terms[:, 0] + terms[:, 1] + terms[:, 2]))


def in_circle(x: jax.Array) -> jax.Array:
    """1 where the last of four points is inside the circle of the others, a positive triangle."""
    r = x[:, :-1] - x[:, -1:]
    return _alternating_sign(_lifts(r), _minors(r, [(1, 2), (0, 2), (0, 1)]))


def in_sphere(x: jax.Array) -> jax.Array:
    """1 where the last of five points is inside the sphere of the others, a positive tetrahedron."""
    r = x[:, :-1] - x[:, -1:]
    return _alternating_sign(_lifts(r), _determinants3(r))


def inside(x: jax.Array, ranks: Sequence[jax.Array]) -> jax.Array:
    """Whether the last of five points is inside by the rule of `space`, bool (n,).

    ``ranks`` are those of the five, each int (n,). The signs of the barycentric coordinates of the last one
    are those of the minors of the in-sphere determinant, as it is expanded.
    """
    r = x[:, :-1] - x[:, -1:]
    minors = _determinants3(r)
    decided = _alternating_sign(_lifts(r), minors)
    *ranks, rank = ranks
    tied = jnp.asarray(False)
    coefficients = sign(minors)
    for k in range(4):
        coefficient = (-1) ** k * coefficients[k]
        closer = (coefficient != 0) & (ranks[k] < rank)
        tied = jnp.where(closer, coefficient > 0, tied)
        rank = jnp.where(closer, ranks[k], rank)
    return jnp.where(decided != 0, decided > 0, tied)


def _take(x: jax.Array, indices: Iterable[int]) -> jax.Array:
    """Entries of the second axis. XLA fuses slices with what uses them; indexing would gather."""
    return jnp.stack([x[:, i] for i in indices], 1)


def _narrow(x: jax.Array) -> jax.Array:
    # products of 32-bit digits are one instruction on CPUs and GPUs
    return carry(x).astype(jnp.int32)


def _minors(r: jax.Array, pairs: Sequence[tuple[int, int]]) -> jax.Array:
    """x_p y_q - x_q y_p of rows p, q, for all pairs."""
    p, q = _take(r, [p for p, _ in pairs]), _take(r, [q for _, q in pairs])
    return _narrow(product(p[:, :, 0], q[:, :, 1]) - product(q[:, :, 0], p[:, :, 1]))


def _determinants3(r: jax.Array) -> jax.Array:
    """Determinants of four rows without the first, the second, the third, the fourth."""
    minors = _minors(r, _PAIRS)
    total: jax.Array | int = 0
    for k, factor in enumerate((1, -1, 1)):
        z = _take(r[:, :, 2], [rows[k] for rows in _OTHERS])
        rest = [tuple(x for x in rows if x != rows[k]) for rows in _OTHERS]
        total = total + factor * product(z, _take(minors, [_PAIRS.index(p) for p in rest]))
    return _narrow(total)  # type: ignore[arg-type]  # which is an array by now


def _lifts(r: jax.Array) -> jax.Array:
    """Squared lengths of all rows."""
    squares = product(r, r)
    return _narrow(sum(squares[:, :, c] for c in range(r.shape[2])))  # type: ignore[arg-type]  # as above


def _alternating_sign(lifts: jax.Array, minors: jax.Array) -> jax.Array:
    """Sign of lift_0 minor_0 - lift_1 minor_1 + ..."""
    terms = product(lifts, minors)
    return sign(carry(sum((-1) ** k * terms[:, k] for k in range(terms.shape[1]))))

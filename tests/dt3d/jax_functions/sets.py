"""Point sets for programs of JAX, by name, and the functions as programs: op by op JAX compiles each op."""

from __future__ import annotations

import itertools

import jax
import numpy as np

import dt3d
import dt3d.jax

delaunay = jax.jit(dt3d.jax.delaunay, static_argnames=("capacity", "on_error"))
volumes = jax.jit(dt3d.jax.volumes)
circumcenters = jax.jit(dt3d.jax.circumcenters)
circumradii = jax.jit(dt3d.jax.circumradii)
find_simplex = jax.jit(dt3d.jax.find_simplex, static_argnames="method")
barycentric = jax.jit(dt3d.jax.barycentric)
interpolate = jax.jit(dt3d.jax.interpolate, static_argnames="method")


def uniform(n: int, d: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((n, d))


def grid(k: int, d: int) -> np.ndarray:
    return np.array(list(itertools.product(*[range(k)] * d)), float)


def on_a_sphere(n: int, d: int) -> np.ndarray:
    sites = np.random.default_rng(1).normal(size=(n, d))
    return sites / np.linalg.norm(sites, axis=1, keepdims=True)


def families(d: int) -> dict[str, np.ndarray]:
    """Of float64 (n, d)."""
    some = uniform(60, d)
    return {
        "uniform": some,
        "simplex": np.concatenate([np.zeros((1, d)), np.eye(d)]),
        "grid": grid(4, d),
        "sphere": on_a_sphere(60, d),
        "duplicates": np.concatenate([some[:30], some[:20], some[10:40]]),
        "offset": some + 1e6,
        "nearly flat": some * [1e-9, *[1] * (d - 1)],
        "tiny": some * 1e-150,
        "subnormal": np.round(some * 1000) * 5e-324,
        "huge": some * 1e150,
    }


def assert_same(mesh: object, points: np.ndarray) -> None:
    """The mesh has the arrays of `dt3d.Delaunay`, then -1."""
    tri = dt3d.Delaunay(points)
    m = len(tri.simplices)
    assert int(mesh.count) == m
    assert int(mesh.status) == 0
    for name in ("simplices", "neighbors"):
        ours, expected = np.asarray(getattr(mesh, name)), getattr(tri, name)
        assert ours.dtype == np.int32
        np.testing.assert_array_equal(ours[:m], expected)
        assert (ours[m:] == -1).all()

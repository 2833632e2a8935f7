"""Volumes, circumcentres and circumradii, and their derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.test_util import check_grads

import dt3d

from .sets import circumcenters, circumradii, delaunay, families, grid, uniform, volumes

MEASURES = [volumes, circumcenters, circumradii]


@pytest.fixture
def x64():
    with jax.enable_x64(True):
        yield


@jax.jit
def all_measures(points, mesh):
    return [measure(points, mesh) for measure in MEASURES]


@jax.jit
def sum_and_slope(points, mesh):
    return jax.value_and_grad(lambda points: sum((a**2).sum() for a in all_measures(points, mesh)))(points)


@pytest.mark.parametrize("d", [2, 3])
def test_derivatives(x64, d):
    points = jnp.asarray(grid(2, d) + 0.2 * uniform(2**d, d, seed=3))
    mesh = delaunay(points, capacity=20)
    check_grads(lambda points: all_measures(points, mesh), (points,), order=1, eps=1e-6)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("name", ["uniform", "grid", "offset", "duplicates", "tiny"])
def test_values(x64, d, name):
    points = families(d)[name]
    mesh = delaunay(points)
    tri = dt3d.Delaunay(points)
    m = len(tri.simplices)
    corners = points[tri.simplices]
    edges = corners[:, 1:] - corners[:, :1]
    expected = np.linalg.det(edges / np.abs(edges).max()) * np.abs(edges).max() ** d / (6 if d == 3 else 2)
    found, centers, radii = all_measures(points, mesh)
    np.testing.assert_allclose(found[:m], expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())
    assert (found[m:] == 0).all()
    # the centre is as far from each corner as the radius says
    scale = np.abs(points).max()
    distances = scale * np.linalg.norm((corners - centers[:m, None]) / scale, axis=2)
    extent = np.ptp(points, axis=0).max()
    round_ones = np.asarray(radii[:m]) < 100 * extent
    np.testing.assert_allclose(
        distances[round_ones],
        np.broadcast_to(radii[:m, None], distances.shape)[round_ones],
        rtol=1e-6,
        atol=1e-9 * scale,
    )
    assert round_ones.sum() > m // 2
    assert (centers[m:] == 0).all()
    assert (radii[m:] == 0).all()


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("scale", [1e-30, 1e30])
def test_float32_does_not_overflow(d, scale):
    points = jnp.asarray(grid(3, d) * scale, jnp.float32)
    mesh = delaunay(points)
    radii = circumradii(points, mesh)
    assert radii.dtype == jnp.float32
    np.testing.assert_allclose(radii[mesh.valid], scale * np.sqrt(d) / 2, rtol=1e-5)
    gradient = jax.jit(jax.grad(lambda points: circumradii(points, mesh).sum() / scale))(points)
    assert np.isfinite(gradient).all()
    assert np.abs(gradient).max() * scale < 10


@pytest.mark.parametrize("d", [2, 3])
def test_the_padding_has_no_part_in_derivatives(d):
    points = jnp.asarray(uniform(20, d), jnp.float32)
    many = delaunay(points)
    few = delaunay(points, capacity=many.count.item())
    for one, other in zip(sum_and_slope(points, few), sum_and_slope(points, many), strict=True):
        assert np.isfinite(other).all()
        np.testing.assert_allclose(one, other, rtol=1e-4)


@pytest.mark.parametrize("d", [2, 3])
def test_simplices_that_have_become_flat_are_finite(d):
    points = jnp.asarray(uniform(20, d), jnp.float32)
    mesh = delaunay(points)
    for moved in (points.at[:, 0].set(0.5), points.at[:, 1].set(points[:, 0]), jnp.zeros_like(points)):
        found, centers, radii = all_measures(moved, mesh)
        for values in (centers, radii, *sum_and_slope(moved, mesh)):
            assert np.isfinite(values).all()
        assert np.abs(centers).max() < 1e7
        assert np.abs(found).max() < 1e-7


def test_the_clamp_of_a_sliver():
    # the square of a grid, one corner lifted by less than its rounding error in float32
    points = jnp.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1e-9], [0.5, 0.5, -1]], jnp.float32)
    mesh = delaunay(points)
    square = jnp.array([[0, 1, 2, 3]], jnp.int32)
    sliver = type(mesh)(square, -jnp.ones_like(square), jnp.array(1), jnp.array(0))
    _, (center,), (radius,) = all_measures(points, sliver)
    assert np.isfinite(center).all()
    assert np.isfinite(radius)
    assert radius < 1e7


def test_a_simplex_that_has_turned_over_is_negative():
    points = jnp.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    mesh = delaunay(points)
    assert volumes(points, mesh)[0] == 0.5
    assert volumes(points * jnp.array([-1.0, 1.0]), mesh)[0] == -0.5


def test_leading_dimensions():
    sets = jnp.stack([uniform(15, 2, seed) for seed in range(6)]).reshape(2, 3, 15, 2)
    mesh = delaunay(sets)
    together = all_measures(sets, mesh)
    each = jax.jit(jax.vmap(jax.vmap(all_measures)))(sets, mesh)
    one = all_measures(sets[1, 2], jax.tree.map(lambda a: a[1, 2], mesh))
    for a, b, c in zip(together, each, one, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-6)
        np.testing.assert_allclose(a[1, 2], c, rtol=1e-5)


def test_errors_when_traced():
    points = jnp.asarray(uniform(15, 2))
    mesh = delaunay(points)
    for wrong in (points[:, :1], points[None], jnp.zeros((15, 3)), jnp.zeros((15, 2), int), 1.0):
        with pytest.raises(
            ValueError, match=r"points must be those of the mesh, floats of shape \(n, 2\), got"
        ):
            volumes(wrong, mesh)
    with pytest.raises(ValueError, match=r"floats of shape \(3, n, 2\), got float32 of shape \(15, 2\)"):
        volumes(points, delaunay(jnp.stack([points] * 3)))


def test_the_volumes_fill_the_hull(x64):
    points = uniform(300, 3)
    points[:8] = grid(2, 3)
    np.testing.assert_allclose(volumes(points, delaunay(points)).sum(), 1, rtol=1e-12)

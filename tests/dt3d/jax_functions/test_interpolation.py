"""Linear interpolation: SciPy's values, and derivatives with respect to all that is real."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.test_util import check_grads
from scipy.interpolate import LinearNDInterpolator

from .sets import barycentric, delaunay, find_simplex, grid, interpolate, uniform


@pytest.fixture
def x64():
    with jax.enable_x64(True):
        yield


@pytest.mark.parametrize("method", ["exact", "walk"])
@pytest.mark.parametrize("d", [2, 3])
def test_the_same_as_scipy(x64, d, method):
    points, xi = uniform(200, d), 1.2 * uniform(500, d, seed=1) - 0.1
    values = np.sin(5 * points).sum(axis=1)
    ours = interpolate(points, delaunay(points), values, xi, method=method)
    theirs = LinearNDInterpolator(points, values)(xi)
    assert np.isnan(theirs).any()
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("d", [2, 3])
def test_derivatives(x64, d):
    points = jnp.asarray(grid(2, d) + 0.2 * uniform(2**d, d, seed=3))
    mesh = delaunay(points)
    values = jnp.asarray(uniform(2**d, 2, seed=1))
    xi = jnp.asarray(0.3 + 0.4 * uniform(6, d, seed=2))
    assert (find_simplex(points, mesh, xi) >= 0).all()
    check_grads(
        lambda points, values, xi: interpolate(points, mesh, values, xi),
        (points, values, xi),
        order=1,
        eps=1e-6,
    )


@pytest.mark.parametrize("d", [2, 3])
def test_outside_there_is_the_fill_value_and_no_derivative(d):
    points = jnp.asarray(uniform(15, d), jnp.float32)
    mesh = delaunay(points)
    values = jnp.ones(15)
    xi = jnp.array([[0.5] * d, [7.0] * d, [np.nan] * d])

    def at(points, values, xi, fill_value):
        return interpolate(points, mesh, values, xi, fill_value=fill_value)

    np.testing.assert_array_equal(jnp.isnan(at(points, values, xi, jnp.nan)), [False, True, True])
    np.testing.assert_allclose(at(points, values, xi, 3.0), [1, 3, 3], rtol=1e-6)

    def inside(*arrays):
        return jnp.nansum(at(*arrays, jnp.nan))

    gradients = jax.jit(jax.grad(inside, argnums=(0, 1, 2)))(points, values, xi)
    assert all(np.isfinite(gradient).all() for gradient in gradients)
    assert (gradients[2][1:] == 0).all()
    np.testing.assert_allclose(gradients[1].sum(), 1, rtol=1e-5)


def test_a_program_from_points_to_values_has_the_gradient_of_differences(x64):
    points, xi = jnp.asarray(uniform(25, 2)), jnp.asarray(0.4 + 0.2 * uniform(7, 2, seed=1))

    def mean(points):
        heights = jnp.sin(4 * points[:, 0]) * points[:, 1]
        return interpolate(points, delaunay(points), heights, xi).mean()

    check_grads(jax.jit(mean), (points,), order=1, modes=["rev", "fwd"], eps=1e-6)


@pytest.mark.parametrize("dtype", [jnp.float32, jnp.int32, jnp.complex64])
def test_dtypes_and_trailing_shapes(dtype):
    points = jnp.asarray(grid(3, 2))
    values = (10 * points[:, :, None] * jnp.ones(3)).astype(dtype)
    xi = jnp.asarray(2 * uniform(8, 2)).reshape(2, 4, 2)
    found = interpolate(points, delaunay(points), values, xi)
    assert found.shape == (2, 4, 2, 3)
    assert found.dtype == (dtype if dtype == jnp.complex64 else jnp.float32)
    np.testing.assert_allclose(found, 10 * xi[..., None] * np.ones(3), rtol=1e-4, atol=1e-4)


def test_batches():
    sets = jnp.stack([uniform(30, 2, seed) for seed in range(3)])
    values, xi = sets.sum(axis=-1), jnp.asarray(0.4 + 0.2 * uniform(3 * 5, 2)).reshape(3, 5, 2)
    mesh = delaunay(sets)
    together = interpolate(sets, mesh, values, xi)
    np.testing.assert_allclose(together, xi.sum(axis=-1), rtol=1e-4)
    np.testing.assert_allclose(jax.vmap(interpolate)(sets, mesh, values, xi), together, rtol=1e-6)


@pytest.mark.parametrize("d", [2, 3])
def test_weights(x64, d):
    points, xi = uniform(50, d), 1.2 * uniform(60, d, seed=1) - 0.1
    mesh = delaunay(points)
    found = np.asarray(find_simplex(points, mesh, xi))
    weights = np.asarray(barycentric(points, mesh, found, xi))
    inside = found >= 0
    assert (weights[~inside] == 0).all()
    assert (weights[inside] >= -1e-14).all()
    np.testing.assert_allclose(weights[inside].sum(axis=1), 1, rtol=1e-14)
    corners = points[np.asarray(mesh.simplices)[found[inside]]]
    np.testing.assert_allclose((weights[inside][:, :, None] * corners).sum(axis=1), xi[inside], rtol=1e-12)


def test_weights_in_a_flat_simplex_are_finite():
    points = jnp.asarray(uniform(6, 3), jnp.float32)
    mesh = delaunay(points)
    flat = points.at[:, 2].set(0.5)
    found = jnp.zeros(3, jnp.int32)
    xi = jnp.asarray(uniform(3, 3, seed=1), jnp.float32)
    assert np.isfinite(barycentric(flat, mesh, found, xi)).all()
    slopes = jax.jit(jax.jacrev(lambda points, xi: barycentric(points, mesh, found, xi), argnums=(0, 1)))
    assert all(np.isfinite(slope).all() for slope in slopes(flat, xi))


def test_errors_when_traced():
    points = jnp.asarray(uniform(6, 2))
    mesh = delaunay(points)
    with pytest.raises(
        ValueError, match=r"values must have shape \(6, ...\), one or more per site, got \(5,\)"
    ):
        interpolate(points, mesh, jnp.zeros(5), points)
    with pytest.raises(ValueError, match=r"found must be integers of shape \(6,\), one per point of xi, got"):
        barycentric(points, mesh, jnp.zeros(6), points)
    with pytest.raises(ValueError, match=r"xi must have shape \(..., 2\), got \(\)"):
        interpolate(points, mesh, jnp.zeros(6), 1.0)

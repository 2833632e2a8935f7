"""The simplex of each query, on the host and by walks."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import dt3d
import dt3d.jax

from .sets import barycentric, delaunay, families, find_simplex, grid, uniform

METHODS = ["exact", "walk"]


@pytest.fixture
def x64():
    with jax.enable_x64(True):
        yield


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("d", [2, 3])
def test_many_queries_in_one_program(x64, d, method):
    n = 10**5 if method == "exact" else 10**4
    points, xi = uniform(n, d), 1.1 * uniform(n, d, seed=1) - 0.05

    def both(points, xi):
        mesh = delaunay(points)
        return mesh, find_simplex(points, mesh, xi, method=method)

    mesh, found = jax.jit(both)(points, xi)
    tri = dt3d.Delaunay(points)
    expected = tri.find_simplex(xi)
    assert (expected == -1).sum() > n // 20
    # threads may have numbered the simplices in another order
    ours, theirs = np.sort(mesh.simplices[found], axis=1), np.sort(tri.simplices[expected], axis=1)
    np.testing.assert_array_equal(found == -1, expected == -1)
    np.testing.assert_array_equal(ours[expected >= 0], theirs[expected >= 0])


# a walk is compiled for each number of sites
HARD = [("exact", name) for name in ("grid", "sphere", "duplicates", "offset", "nearly flat", "tiny")]
HARD += [("walk", name) for name in ("sphere", "offset", "nearly flat", "tiny")]


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize(("method", "name"), HARD)
def test_hard_sets(x64, d, name, method):
    points = families(d)[name]
    tri = dt3d.Delaunay(points)
    low, high = points.min(axis=0), points.max(axis=0)
    inside = tri.points[tri.simplices].mean(axis=1)[:100]
    outside = low - (high - low) * (0.1 + uniform(20, d))
    not_finite = np.array([[np.nan] * d, [np.inf] * d])
    found = find_simplex(
        points, delaunay(points), np.concatenate([inside, outside, not_finite]), method=method
    )
    assert (found[len(inside) :] == -1).all()
    found = found[: len(inside)]
    # the centroids of simplices that are flat within rounding may be found beside them
    corners = points[tri.simplices[:100]]
    edges = (corners[:, 1:] - corners[:, :1]) / (high - low).max()
    solid = np.abs(np.linalg.det(edges)) > 1e-12 * np.linalg.norm(edges, axis=2).prod(axis=1)
    np.testing.assert_array_equal(found[solid], np.flatnonzero(solid))
    assert solid.sum() > len(solid) // 2 or name == "nearly flat"


@pytest.mark.parametrize("d", [2, 3])
def test_points_on_borders_are_found(x64, d):
    points = grid(4, d)
    mesh = delaunay(points)
    xi = np.concatenate([grid(7, d) / 2, grid(4, d)])
    for method in METHODS:
        found = np.asarray(find_simplex(points, mesh, xi, method=method))
        assert (found >= 0).all()
        weights = barycentric(points, mesh, found, xi)
        assert weights.min() >= 0


@pytest.mark.parametrize("d", [2, 3])
def test_walks_in_float32_are_right_up_to_rounding(d):
    points = uniform(3000, d).astype(np.float32)
    xi = uniform(3000, d, seed=1).astype(np.float32)
    mesh = delaunay(points)
    exact, walked = (np.asarray(find_simplex(points, mesh, xi, method=method)) for method in METHODS)
    assert (exact == walked).mean() > 0.99
    beside = (exact != walked) & (walked >= 0)
    weights = barycentric(points, mesh, walked, xi)
    assert weights[beside].min(initial=0) > -1e-3


@pytest.mark.parametrize("method", METHODS)
def test_batches(method):
    sets = jnp.stack([uniform(30, 2, seed) for seed in range(6)]).reshape(2, 3, 30, 2)
    xi = jnp.asarray(uniform(2 * 3 * 4 * 5, 2, seed=9)).reshape(2, 3, 4, 5, 2)
    mesh = delaunay(sets)
    together = find_simplex(sets, mesh, xi, method=method)
    assert together.shape == (2, 3, 4, 5)
    for i in range(2):
        for j in range(3):
            expected = dt3d.Delaunay(sets[i, j]).find_simplex(xi[i, j])
            np.testing.assert_array_equal(together[i, j], expected)
    nested = jax.jit(jax.vmap(jax.vmap(lambda s, m, x: find_simplex(s, m, x, method=method))))(sets, mesh, xi)
    np.testing.assert_array_equal(nested, together)


@pytest.mark.parametrize("method", METHODS)
def test_one_mesh_and_many_queries_and_the_reverse(method):
    points, xi = jnp.asarray(uniform(30, 2)), jnp.asarray(uniform(40, 2, seed=1)).reshape(4, 10, 2)
    mesh = delaunay(points)
    one_mesh = jax.vmap(lambda x: find_simplex(points, mesh, x, method=method))(xi)
    np.testing.assert_array_equal(one_mesh, dt3d.Delaunay(points).find_simplex(xi))
    sets = jnp.stack([points, points[::-1]])
    one_xi = jax.vmap(lambda s, m: find_simplex(s, m, xi[0], method=method))(sets, delaunay(sets))
    for points, found in zip(sets, one_xi, strict=True):
        np.testing.assert_array_equal(found, dt3d.Delaunay(points).find_simplex(xi[0]))
    # as if each query came by itself, with a mesh of its own for each of two sets
    both = jax.vmap(
        jax.vmap(lambda s, m, x: find_simplex(s, m, x, method=method), (None, None, 0)), (0, 0, None)
    )
    found = both(sets, delaunay(sets), xi)
    np.testing.assert_array_equal(found[:, 0], one_xi)


def test_one_locator_for_all_that_ask_a_set(monkeypatch):
    made = []
    locator = dt3d.jax.host.Locator

    def counted(*arrays):
        made.append(len(arrays[0]))
        return locator(*arrays)

    monkeypatch.setattr(dt3d.jax.host, "Locator", counted)
    points, xi = jnp.asarray(uniform(30, 2)), jnp.asarray(uniform(40, 2, seed=1)).reshape(4, 10, 2)
    mesh = delaunay(points)
    jax.block_until_ready(jax.vmap(lambda x: dt3d.jax.find_simplex(points, mesh, x))(xi))
    assert made == [30]


@pytest.mark.parametrize("method", METHODS)
def test_meshes_without_simplices_and_queries_without_points(method):
    points = jnp.ones((6, 2))
    mesh = delaunay(points, on_error="status")
    assert find_simplex(points, mesh, points, method=method).tolist() == [-1] * 6
    points = jnp.asarray(uniform(6, 2))
    mesh = delaunay(points)
    assert find_simplex(points, mesh, jnp.zeros((0, 2)), method=method).shape == (0,)
    assert find_simplex(points, mesh, points.mean(axis=0), method=method).shape == ()


def test_integers_and_other_precisions_as_queries(x64):
    points = np.array([[0, 0], [4, 0], [0, 4]], np.float32)
    mesh = delaunay(points)
    for method in METHODS:
        assert find_simplex(points, mesh, np.array([[1, 1], [3, 3]]), method=method).tolist() == [0, -1]
        # not a float32 number: beyond the border as it is, on it when rounded
        beyond = np.array([2.0, 2.0 + 2**-30])
        assert find_simplex(points, mesh, beyond, method=method) == -1


def test_errors_when_traced():
    points = jnp.asarray(uniform(6, 2))
    mesh = delaunay(points)
    with pytest.raises(ValueError, match=r"xi must have shape \(..., 2\), got \(4, 3\)"):
        find_simplex(points, mesh, jnp.zeros((4, 3)))
    with pytest.raises(ValueError, match='method must be "exact" or "walk", got \'jump\''):
        find_simplex(points, mesh, points, method="jump")
    sets = jnp.stack([points] * 3)
    with pytest.raises(ValueError, match=r"must have shape \(3, ..., 2\), got \(6, 2\); for other leading"):
        find_simplex(sets, delaunay(sets), points)

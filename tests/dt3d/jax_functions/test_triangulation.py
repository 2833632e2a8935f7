"""`dt3d.jax.delaunay` finds what `dt3d.Delaunay` does, in every kind of program."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.errors import JaxRuntimeError

import dt3d
import dt3d.jax
from dt3d.jax import Status

from .sets import assert_same, delaunay, families, uniform, volumes

# JAX makes a ValueError of some errors of callbacks
FAILED = (JaxRuntimeError, ValueError)
FAMILIES = [(d, name) for d in (2, 3) for name in families(d)]


@pytest.fixture
def x64():
    with jax.enable_x64(True):
        yield


@pytest.mark.parametrize(("d", "name"), FAMILIES)
def test_the_same_as_the_class(x64, d, name):
    points = families(d)[name]
    assert_same(delaunay(points), points)


@pytest.mark.parametrize("d", [2, 3])
def test_float32_gives_what_its_widening_gives(d):
    points = uniform(200, d).astype(np.float32)
    mesh = delaunay(jnp.asarray(points))
    assert not jax.config.jax_enable_x64
    assert_same(mesh, points.astype(np.float64))


@pytest.mark.parametrize("d", [2, 3])
def test_subnormal_float32(d):
    points = (np.round(uniform(30, d) * 1000) * 1.5e-45).astype(np.float32)
    assert (points < 1e-38).all()
    assert_same(delaunay(points), points.astype(np.float64))


@pytest.mark.parametrize("d", [2, 3])
def test_batches(x64, d):
    sets = np.stack([uniform(40, d, seed) for seed in range(6)]).reshape(2, 3, 40, d)
    leading = delaunay(sets)
    nested = jax.jit(jax.vmap(jax.vmap(delaunay)))(sets)
    last = jax.vmap(delaunay, in_axes=2)(jnp.moveaxis(sets[0], 0, 2))
    for i in range(2):
        for j in range(3):
            for mesh in (leading, nested):
                assert_same(jax.tree.map(lambda a, i=i, j=j: a[i, j], mesh), sets[i, j])
    for j in range(3):
        assert_same(jax.tree.map(lambda a, j=j: a[j], last), sets[0, j])


def test_one_call_of_the_host_for_a_batch(monkeypatch):
    calls = []
    triangulate = dt3d.jax.triangulation.triangulate_or_raise

    def counted(given, results):
        calls.append(given[0].shape)
        triangulate(given, results)

    monkeypatch.setattr(dt3d.jax.triangulation, "triangulate_or_raise", counted)
    sets = jnp.asarray(uniform(8 * 10, 3).reshape(2, 4, 10, 3))
    jax.block_until_ready(jax.jit(jax.vmap(jax.vmap(dt3d.jax.delaunay)))(sets))
    assert calls == [(2, 4, 10, 3)]


def test_large_sets_get_all_threads_one_after_another():
    sets = uniform(21_000, 2).astype(np.float32)[None]
    mesh = delaunay(sets)
    expected = dt3d.Delaunay(sets[0])
    assert mesh.count.tolist() == [len(expected.simplices)]


def test_an_empty_batch():
    mesh = delaunay(jnp.zeros((0, 5, 3)))
    assert mesh.simplices.shape == (0, 104, 4)
    assert mesh.count.shape == (0,)


def total(points):
    mesh = delaunay(points)
    return (volumes(points, mesh) ** 2).sum()


gradient = jax.jit(jax.grad(total))


@pytest.mark.parametrize("d", [2, 3])
def test_gradients_are_those_of_a_fixed_mesh(x64, d):
    points = jnp.asarray(uniform(30, d))
    mesh = delaunay(points)
    fixed = jax.jit(jax.grad(lambda points: (volumes(points, mesh) ** 2).sum()))(points)
    np.testing.assert_allclose(gradient(points), fixed, rtol=1e-12)
    for other in (jax.jacfwd(total), jax.grad(jax.checkpoint(total))):
        np.testing.assert_allclose(jax.jit(other)(points), fixed, rtol=1e-12)


def test_derivatives_outside_jit(x64):
    points = jnp.asarray(uniform(30, 2))
    np.testing.assert_allclose(jax.grad(total)(points), gradient(points), rtol=1e-12)


def test_gradients_of_a_batch(x64):
    sets = jnp.stack([uniform(20, 3, seed) for seed in range(3)])
    together = jax.jit(jax.vmap(jax.grad(total)))(sets)
    for points, one in zip(sets, together, strict=True):
        np.testing.assert_allclose(one, gradient(points), rtol=1e-12)


def test_steps_of_a_scan(x64):
    start = jnp.asarray(uniform(40, 3))

    def step(points, _):
        moved = points - 0.1 * jax.grad(total)(points)
        return moved, delaunay(moved).count

    last, counts = jax.jit(lambda points: jax.lax.scan(step, points, length=5))(start)
    points = start
    for count in counts.tolist():
        points = points - 0.1 * gradient(points)
        assert count == len(dt3d.Delaunay(points).simplices)
    np.testing.assert_allclose(last, points, rtol=1e-12)
    through = jax.jit(jax.grad(lambda points: jax.lax.scan(step, points, length=2)[0].sum()))(start)
    assert np.isfinite(through).all()


def test_capacity():
    points = uniform(50, 3).astype(np.float32)
    m = len(dt3d.Delaunay(points).simplices)
    just = delaunay(points, capacity=m)
    assert just.valid.all()
    assert just.count == m
    short = delaunay(points, capacity=m - 1, on_error="status")
    assert (short.count, short.status) == (m, Status.OVERFLOW)
    assert (short.simplices == -1).all()
    assert (short.neighbors == -1).all()
    with pytest.raises(
        JaxRuntimeError, match=f"50 sites have {m} tetrahedra, more than capacity={m - 1}; pass"
    ):
        jax.block_until_ready(delaunay(points, capacity=m - 1))


@pytest.mark.parametrize("d", [2, 3])
def test_what_is_wrong_with_a_set_of_a_batch(d):
    good = uniform(20, d).astype(np.float32)
    not_finite, infinite, flat = good.copy(), good.copy(), good.copy()
    not_finite[3, 1] = np.nan
    infinite[4, 0] = -np.inf
    flat[:, 0] = 1
    sets = jnp.stack([good, not_finite, infinite, flat, np.ones_like(good)])
    mesh = jax.jit(jax.vmap(lambda points: delaunay(points, on_error="status")))(sets)
    assert mesh.status.tolist() == [0, 2, 2, 4, 4]
    assert mesh.count[1:].tolist() == [0] * 4
    assert (mesh.simplices[1:] == -1).all()
    assert_same(jax.tree.map(lambda a: a[0], mesh), good.astype(np.float64))
    slopes = jax.jit(jax.grad(lambda sets: volumes(sets, mesh).sum()))(sets)
    assert (slopes[1:] == 0).all()
    for points, message in (
        (not_finite, "points must be finite: 1 rows have NaN or infinity, the first is 3; on_error="),
        (flat, f"a triangulation needs {'three' if d == 2 else 'four'} sites that do not lie on a"),
    ):
        with pytest.raises(FAILED, match=message):
            jax.block_until_ready(delaunay(points))
    with pytest.raises(FAILED, match="set 1 of 2: points must be finite"):
        jax.block_until_ready(delaunay(jnp.stack([good, infinite])))


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        (
            np.zeros((3, 9)),
            {},
            r"points must have shape \(..., n, 2\) or \(..., n, 3\), got \(3, 9\); it looks",
        ),
        (np.zeros(3), {}, r"got \(3,\)"),
        (np.zeros((9, 4)), {}, r"got \(9, 4\)"),
        (np.zeros((9, 3), int), {}, r"must be float32 or float64, got int32; pass points.astype"),
        (np.zeros((3, 3)), {}, r"needs n >= 4, got shape \(3, 3\)"),
        (np.zeros((7, 2, 2)), {}, r"needs n >= 3, got shape \(7, 2, 2\)"),
        (np.zeros((9, 3)), {"capacity": 0}, "capacity must be a positive integer that is known when"),
        (np.zeros((9, 3)), {"capacity": True}, "got True"),
        (np.zeros((9, 3)), {"capacity": 2**29}, "536870912 rows of 4 are too many"),
        (np.zeros((9, 3)), {"on_error": "ignore"}, 'on_error must be "raise" or "status", got \'ignore\''),
    ],
)
def test_errors_when_traced(points, options, message):
    with pytest.raises(ValueError, match=message):
        jax.eval_shape(lambda points: dt3d.jax.delaunay(points, **options), points)


def test_a_traced_capacity():
    with pytest.raises(ValueError, match="known when the program is traced, got a traced value"):
        jax.jit(dt3d.jax.delaunay)(jnp.zeros((9, 3)), 7)


def test_too_many_sites():
    with pytest.raises(ValueError, match="at most 2\\^25 = 33554432 sites can be numbered"):
        jax.eval_shape(delaunay, jax.ShapeDtypeStruct((2**25 + 1, 2), jnp.float32))


def test_calls_outside_jit_compile_once():
    points = jnp.asarray(uniform(10, 3))
    dt3d.jax.delaunay(points)
    before = dt3d.jax.callback._compiled.cache_info()
    dt3d.jax.delaunay(points + 1)
    after = dt3d.jax.callback._compiled.cache_info()
    assert (after.misses, after.hits) == (before.misses, before.hits + 1)

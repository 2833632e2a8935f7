"""Alpha complexes beside GUDHI's, and beside the definition."""

import itertools
from fractions import Fraction

import gudhi
import numpy as np
import pytest

import dt3d

RNG = np.random.default_rng(2)


def grid(d, k):
    return np.stack(np.meshgrid(*[np.arange(float(k))] * d), -1).reshape(-1, d)


SETS = {
    f"{name}, d = {d}": points
    for d in (2, 3)
    for name, points in {
        "random": RNG.random((60, d)),
        "uneven": RNG.random((60, d)) ** 6,
        "far away": RNG.random((60, d)) + 1e4,
        "tiny": RNG.random((60, d)) * 1e-60,
        "one simplex": RNG.random((d + 1, d)),
        "with an obtuse angle": np.concatenate([[[0.1] * d], [[-0.1] * d], np.eye(d)]),
    }.items()
}
COSPHERICAL = {
    "a grid in the plane": grid(2, 4),
    "a grid in space": grid(3, 3),
    "duplicates in the plane": np.concatenate([SETS["random, d = 2"][:30]] * 2),
    "duplicates in space": np.concatenate([SETS["random, d = 3"][:30]] * 2),
    "a circle": np.column_stack([np.cos(np.arange(12.0)), np.sin(np.arange(12.0))]),
}


def theirs(points, precision="exact"):
    return gudhi.AlphaComplex(points=points.tolist(), precision=precision).create_simplex_tree()


@pytest.mark.parametrize("precision", ["exact", "safe"])
@pytest.mark.parametrize("name", SETS)
def test_values_are_those_of_gudhi(name, precision):
    alpha = dt3d.Delaunay(SETS[name]).alpha_complex()
    ours = dict(alpha)
    tree = theirs(SETS[name], precision)  # which has to live while it is gone through
    wanted = {tuple(simplex): value for simplex, value in tree.get_filtration()}
    assert ours.keys() == wanted.keys()
    assert len(ours) == len(alpha) == sum(map(len, alpha.simplices))
    # "safe" promises the simplices, and values to about 1e-5
    rtol = 1e-12 if precision == "exact" else 1e-5
    np.testing.assert_allclose([ours[s] for s in wanted], list(wanted.values()), rtol=rtol)


@pytest.mark.parametrize("name", SETS | COSPHERICAL)
def test_persistence_is_that_of_gudhi(name):
    """Where sites are cospherical the simplices may be others; what appears and ends when may not."""
    points = (SETS | COSPHERICAL)[name]
    mine, other = dt3d.Delaunay(points).alpha_complex().to_gudhi(), theirs(points)
    for tree in (mine, other):
        tree.compute_persistence()
    size = np.ptp(points) ** 2
    for k in range(points.shape[1]):
        pair = []
        for tree in (mine, other):
            bars = tree.persistence_intervals_in_dimension(k)
            bars = bars[bars[:, 1] - bars[:, 0] > 1e-9 * size] if len(bars) else bars
            pair.append(sorted(map(tuple, bars.tolist())))
        np.testing.assert_allclose(*pair, rtol=1e-9, atol=1e-12 * size)


@pytest.mark.parametrize("name", SETS | COSPHERICAL)
def test_the_order_is_a_filtration(name):
    tri = dt3d.Delaunay((SETS | COSPHERICAL)[name])
    alpha = tri.alpha_complex()
    seen, last = set(), 0.0
    for simplex, value in alpha:
        assert value >= last
        assert list(simplex) == sorted(simplex)
        assert all(face in seen for face in itertools.combinations(simplex, len(simplex) - 1) if face)
        seen.add(simplex)
        last = value
    d = tri.ndim
    assert len(alpha.simplices) == len(alpha.values) == d + 1
    for k in range(1, d + 1):
        for i in range(k + 1):
            faces = alpha.simplices[k - 1][alpha.faces[k][:, i]]
            np.testing.assert_array_equal(faces, np.delete(alpha.simplices[k], i, axis=1))
            assert (alpha.values[k - 1][alpha.faces[k][:, i]] <= alpha.values[k]).all()
    # of a ball
    assert sum((-1) ** k * len(values) for k, values in enumerate(alpha.values)) == 1
    np.testing.assert_array_equal(np.sort(alpha.values[d]), np.sort(tri.circumradii**2))
    with pytest.raises(ValueError, match="read-only"):
        alpha.values[d][:] = 0


def test_the_boundary_of_a_boundary_is_zero():
    alpha = dt3d.Delaunay(RNG.random((40, 3))).alpha_complex()
    matrix = alpha.boundary_matrix()
    assert matrix.shape == (len(alpha), len(alpha))
    assert ((matrix.astype(int) @ matrix.astype(int)).toarray() % 2 == 0).all()
    rows, columns = matrix.nonzero()
    assert (rows < columns).all()
    dimensions = alpha.order()[0]
    np.testing.assert_array_equal(np.diff(matrix.indptr), np.where(dimensions == 0, 0, dimensions + 1))


def smallest_sphere(corners):
    """The center of the smallest sphere through 2 to 4 points, and its squared radius, as fractions."""
    a, *others = [[Fraction(x) for x in row] for row in corners.tolist()]
    sides = [[x - y for x, y in zip(row, a, strict=True)] for row in others]
    gram = [[sum(x * y for x, y in zip(u, v, strict=True)) for v in sides] for u in sides]
    system = [[*row, gram[i][i] / 2] for i, row in enumerate(gram)]
    for i in range(len(system)):  # Gauss and Jordan
        system[i] = [x / system[i][i] for x in system[i]]
        for j in range(len(system)):
            if j != i:
                system[j] = [x - system[j][i] * y for x, y in zip(system[j], system[i], strict=True)]
    center = [x + sum(row[-1] * u[k] for row, u in zip(system, sides, strict=True)) for k, x in enumerate(a)]
    return center, sum((x - y) ** 2 for x, y in zip(center, a, strict=True))


@pytest.mark.parametrize("d", [2, 3])
def test_values_are_those_of_the_definition(d):
    points = RNG.integers(0, 1000, (25, d)).astype(float)
    tri = dt3d.Delaunay(points)
    ours = dict(tri.alpha_complex())
    exact = {tuple(sorted(t)): smallest_sphere(points[t])[1] for t in tri.simplices.tolist()}
    for k in range(d, 1, -1):
        above = [simplex for simplex in exact if len(simplex) == k + 1]
        bounded = {}
        for simplex in above:
            for face in itertools.combinations(simplex, k):
                bounded.setdefault(face, []).append(simplex)
        for face, simplices in bounded.items():
            center, square = smallest_sphere(points[list(face)])
            empty = all(
                sum((Fraction(x) - c) ** 2 for x, c in zip(site, center, strict=True)) >= square
                for i, site in enumerate(points.tolist())
                if i not in face
            )
            exact[face] = square if empty else min(exact[s] for s in simplices)
    assert len(exact) + len(points) == len(ours)
    for simplex, square in exact.items():
        assert ours[simplex] == pytest.approx(float(square), rel=1e-12)


def test_without_gudhi_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "gudhi", None)
    with pytest.raises(ImportError, match="to_gudhi.. needs GUDHI.* pip install gudhi"):
        dt3d.Delaunay(SETS["random, d = 2"]).alpha_complex().to_gudhi()

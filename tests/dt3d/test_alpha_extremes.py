"""Alpha values where doubles do not tell: sites of turned grids on lines and planes, extreme magnitudes."""

import itertools

import gudhi
import numpy as np
import pytest

import dt3d


def sets():
    rng = np.random.default_rng(11)
    for d in (2, 3):
        grid = np.array(list(itertools.product(range(5), repeat=d)), float)
        turned, _ = np.linalg.qr(rng.normal(size=(d, d)))
        yield f"turned grid {d}", grid @ turned + 0.1
        yield f"thin {d}", rng.random((100, d)) * [*[1] * (d - 1), 1e-12]
        yield f"magnitudes {d}", rng.normal(size=(80, d)) * 10.0 ** rng.integers(-12, 12, (80, 1))
        yield f"far {d}", 1e9 + rng.random((100, d))
        yield f"huge {d}", 1e120 * rng.random((80, d))
        yield f"tiny {d}", 1e-120 * rng.random((80, d))


SETS = dict(sets())


@pytest.mark.parametrize("name", SETS)
def test_values_are_those_of_exact_arithmetic(name):
    points = SETS[name]
    # GUDHI multiplies squares, which leave the range of doubles; a power of two is exact
    unit = 2.0 ** np.round(np.log2(np.abs(points).max()))
    tree = gudhi.AlphaComplex(points=(points / unit).tolist(), precision="exact").create_simplex_tree()
    theirs = {tuple(simplex): value * unit * unit for simplex, value in tree.get_filtration()}
    ours = dict(dt3d.Delaunay(points).alpha_complex())
    assert ours.keys() == theirs.keys()
    np.testing.assert_allclose([ours[s] for s in theirs], list(theirs.values()), rtol=1e-9, atol=0)


@pytest.mark.parametrize("name", SETS)
def test_no_face_has_a_greater_value_than_a_coface(name):
    values = dict(dt3d.Delaunay(SETS[name]).alpha_complex())
    for simplex, value in values.items():
        for k in range(len(simplex) if len(simplex) > 1 else 0):
            assert values[simplex[:k] + simplex[k + 1 :]] <= value

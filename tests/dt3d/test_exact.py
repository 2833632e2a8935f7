"""The oracle itself: it must see what is wrong."""

from types import SimpleNamespace

import numpy as np
import pytest

import dt3d

from .exact import FACETS, in_sphere, integers, orient, validate
from .meshes import cover, facets_of, round_an_axis, slit_axis

SIMPLEX = integers(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]))


def test_signs():
    assert orient(*SIMPLEX) == 1
    inside, outside, on = integers(np.array([[0.25, 0.25, 0.25], [2, 2, 2], [1, 1, 1.0]]))
    corners = SIMPLEX * 4  # `integers` scaled the three by 4, for the quarter
    assert in_sphere(*corners, inside) > 0
    assert in_sphere(*corners, outside) < 0
    assert in_sphere(*corners, on) == 0


def test_it_passes_what_is_right(cube):
    validate(cube)


@pytest.mark.parametrize("harm", ["turn", "drop", "neighbor", "move", "hull"])
def test_it_fails_what_is_wrong(cube, harm):
    if harm == "turn":
        cube.simplices[0] = cube.simplices[0][[1, 0, 2, 3]]
    elif harm == "drop":
        cube.duplicates = cube.duplicates[:0]
    elif harm == "neighbor":
        cube.neighbors[0, 0] = (cube.neighbors[0, 0] + 1) % 6
    elif harm == "move":
        cube.points[7] = cube.points[8] + 0.25  # one corner far inside
    else:
        cube.convex_hull[0] = cube.convex_hull[0][[1, 0, 2]]
    with pytest.raises((AssertionError, KeyError)):
        validate(cube)


def with_neighbors(points, simplices):
    """A mesh as the oracle takes it, whatever it is."""
    rows = [row if orient(*integers(points[row])) > 0 else row[[1, 0, 2, 3]] for row in np.asarray(simplices)]
    simplices = np.array(rows, np.int32)
    neighbors, hull = np.full(simplices.shape, -1, np.int32), []
    sides = facets_of(simplices)
    for t, row in enumerate(simplices.tolist()):
        for k, facet in enumerate(FACETS):
            corners = [row[j] for j in facet]
            others = [u for u in sides[frozenset(corners)] if u != t]
            if others:
                neighbors[t, k] = others[0]
            else:
                hull.append(corners)
    return SimpleNamespace(
        points=points,
        simplices=simplices,
        neighbors=neighbors,
        convex_hull=np.array(hull, np.int32),
        duplicates=np.empty((0, 2), np.int32),
    )


def test_it_passes_what_winds_once():
    validate(with_neighbors(*round_an_axis(5, 1, 0.5)))
    validate(with_neighbors(np.eye(4, 3), [[0, 1, 2, 3]]))


@pytest.mark.parametrize("height", [0.3, 0.5, 0.7])
@pytest.mark.parametrize(("corners", "step"), [(5, 2), (7, 3)])
def test_it_fails_what_winds_twice(corners, step, height):
    with pytest.raises(AssertionError, match="a point is covered more than once"):
        validate(with_neighbors(*round_an_axis(corners, step, height)))


def test_it_fails_a_slit_whose_sides_lie_in_one_plane():
    with pytest.raises(AssertionError, match="the hull is seen from outside"):
        validate(with_neighbors(*slit_axis(5, 0.5)))


def test_it_fails_components():
    unit = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    for other in (unit + 0.125, unit / 8 + 0.125, -unit - 10):
        with pytest.raises(AssertionError):
            validate(with_neighbors(np.concatenate([unit, other]), [[0, 1, 2, 3], [4, 5, 6, 7]]))


def test_it_fails_two_on_one_side_of_a_facet():
    points = np.concatenate([np.zeros((1, 3)), np.eye(3), [[1, 1, 1]]])
    with pytest.raises(AssertionError, match="two tetrahedra are on one side of a facet"):
        validate(with_neighbors(points, [[0, 1, 2, 3], [0, 1, 2, 4]]))


@pytest.mark.parametrize("sheets", [2, 3])
def test_it_fails_covers_however_they_branch(sheets):
    rng = np.random.default_rng(sheets)
    for n in np.repeat([6, 9, 12], 8):
        points = rng.random((n, 3))
        simplices = dt3d.Delaunay(points).simplices
        inner = [facet for facet, sides in facets_of(simplices).items() if len(sides) == 2]
        chosen = rng.permutation(len(inner))[: rng.integers(0, 1 + len(inner))]
        shift = {inner[i]: int(rng.integers(1, sheets)) for i in chosen}
        with pytest.raises((AssertionError, KeyError)):
            validate(with_neighbors(*cover(points, simplices, sheets, shift)))

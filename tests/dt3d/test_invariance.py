"""What must not change the triangulation: order, scale and place of the sites, and the machine."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import dt3d
import scanvec as sv

from .exact import canonical, check_indices, validate
from .families import SMALL, check_ties, tetrahedra, ties

METHODS = ["insertion", "extrapolation"]
EXAMPLES = {"insertion": 40, "extrapolation": 6}  # extrapolation takes up to a second for each
CORNER = np.concatenate([np.zeros((1, 3)), np.eye(3)])


def sites(reach):
    """Up to 44 sites with integer coordinates up to ``reach``, not all on a plane, some of them equal."""
    rows = st.tuples(st.integers(0, 40), st.just(3))
    drawn = arrays(np.int64, rows, elements=st.integers(-reach, reach), fill=st.nothing())
    return drawn.map(lambda more: np.concatenate([CORNER, more]))


COSPHERICAL, SCATTERED = sites(3), sites(2**20)


def reordered(data, points):
    return points[data.draw(st.permutations(range(len(points))))]


def rescaled(data, points):
    return np.ldexp(points, data.draw(st.integers(-1000, 1000)))


def moved(data, points):
    """Moved by integers and a power of two, all of which float64 adds without rounding."""
    shift = data.draw(st.tuples(*[st.integers(-(2**40), 2**40)] * 3))
    return points + np.array(shift) + 2.0 ** data.draw(st.integers(0, 50))


@pytest.mark.parametrize(
    ("change", "method"),
    [
        pytest.param(
            change, method, marks=[pytest.mark.slow] * (method == "extrapolation" and change != moved)
        )
        for change in (reordered, rescaled, moved)
        for method in METHODS
    ],
)
def test_the_same_tetrahedra(change, method):
    @settings(max_examples=EXAMPLES[method])
    @given(COSPHERICAL | SCATTERED, st.data())
    def holds(points, data):
        tri = dt3d.Delaunay(points, method=method)
        validate(tri)
        same = change(data, points)
        got = dt3d.Delaunay(same, method=method)
        check_indices(got)
        np.testing.assert_array_equal(tetrahedra(got), tetrahedra(tri))

    holds()


@pytest.mark.parametrize("method", METHODS)
def test_mirrored_axes(method):
    """The perturbation goes by the order of coordinates: a mirror may change how ties split, and no more."""

    @settings(max_examples=EXAMPLES[method])
    @given(COSPHERICAL | SCATTERED, st.tuples(*[st.sampled_from([-1, 1])] * 3), st.permutations(range(3)))
    def holds(points, signs, axes):
        tri = dt3d.Delaunay(points, method=method)
        mirrored = dt3d.Delaunay((points * signs)[:, axes], method=method)
        validate(mirrored)
        check_ties(mirrored)
        np.testing.assert_array_equal(mirrored.duplicates, tri.duplicates)
        if not len(ties(tri)):  # five sites on an empty sphere are a tie of two neighbours
            np.testing.assert_array_equal(canonical(mirrored.simplices), canonical(tri.simplices))

    holds()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["grid 4", "skew lines", "integer sphere 81", "tenths", "random integers"])
def test_machines_give_equal_arrays_for_degenerate_sets(name):
    machines = sv.Device(), sv.Simulated(processors=3), sv.Simulated(processors=32)
    first, *others = (
        dt3d.Delaunay(SMALL[name], method="extrapolation", robustness="exact", machine=m) for m in machines
    )
    validate(first)
    check_ties(first)
    for other in others:
        for array in ("simplices", "neighbors", "iteration", "duplicates"):
            np.testing.assert_array_equal(getattr(other, array), getattr(first, array))

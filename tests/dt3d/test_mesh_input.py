"""Indices are checked before they are used: in space, in the plane, and from files."""

import re

import numpy as np
import pytest

import dt3d
from dt3d import cli, threaded2d, verification

SPACE = np.random.default_rng(0).random((20, 3))


@pytest.fixture(scope="module", params=[4, 3], ids=["space", "plane"])
def case(request):
    """A `verify` with what is right filled in, the right simplices and neighbors, and their name."""
    corners = request.param
    sites = SPACE[:, : corners - 1]
    if corners == 4:
        tri = dt3d.Delaunay(sites)
        good, prove, name = tri.simplices, verification.verify, "simplices"
    else:
        tri = threaded2d.Delaunay(sites)
        good, prove, name = tri.triangles, threaded2d.verify, "triangles"

    def verify(simplices=good, points=sites, **options):
        return prove(points, simplices, **options)

    return verify, np.array(good), np.array(tri.neighbors), name


def test_indices_that_are_no_rows_of_sites(case):
    verify, good, _neighbors, name = case
    corners = good.shape[1]
    largest = int(good.max())
    for wrong, text in [
        (good.astype(np.int64) + 2**32, f"{name} name sites {2**32} to {2**32 + largest}, but there are 20"),
        (good.astype(np.uint64) + np.uint64(2**63), f"{name} name sites {2**63} to"),
        (good.astype(np.int64) - 1, f"{name} name sites -1 to {largest - 1}, but there are 20 points"),
        (good + 1, f"{name} name sites 1 to 20, but there are 20 points"),
        (good + 0.5, f"{name} must be integers of shape (m, {corners}), got dtype float64"),
        (good + 0.0, f"{name} must be integers of shape (m, {corners}), got dtype float64"),
        (good > 0, f"{name} must be integers of shape (m, {corners}), got dtype bool"),
        (good.astype(object), f"{name} must be integers of shape (m, {corners}), got dtype object"),
        (good.astype(str), f"{name} must be integers of shape (m, {corners}), got dtype <U"),
        (good[:, 1:], f"{name} must have shape (m, {corners}), got ({len(good)}, {corners - 1})"),
        (good.ravel(), f"{name} must have shape (m, {corners}), got ({good.size},)"),
        (good[None], f"{name} must have shape (m, {corners}), got (1, {len(good)}, {corners})"),
        (good[0, 0], f"{name} must have shape (m, {corners}), got ()"),
        (
            [[0, 1, 2, 3], [0, 1]],
            f"{name} must be integers of shape (m, {corners}); the rows that came do not",
        ),
        (np.ma.masked_equal(good, 5), f"{name} have masked entries; drop those rows first"),
    ]:
        with pytest.raises(ValueError, match=re.escape(text)):
            verify(wrong)


@pytest.mark.parametrize("dtype", [np.int8, np.uint8, np.int32, np.uint32, np.int64, np.uint64, ">i4", ">u8"])
def test_indices_of_any_integer_type_in_any_order(case, dtype):
    verify, good, _, _ = case
    assert verify(np.asfortranarray(good.astype(dtype)))
    assert verify(good.astype(dtype).tolist())


def test_points_that_are_none(case):
    verify, good, _neighbors, _name = case
    corners = good.shape[1]
    d = corners - 1
    points = SPACE[:, :d]
    hole = points.copy()
    hole[7, 1] = np.nan
    for wrong, text in [
        (points + 1j, "points must be real numbers, got dtype complex128"),
        (hole, "points must be finite: 1 rows have NaN or infinity, the first is row 7"),
        (np.ones((20, d + 1)), f"points must have shape (n, {d}), got (20, {d + 1})"),
        (points[:0], "points are empty"),
    ]:
        with pytest.raises(ValueError, match=re.escape(text)):
            verify(points=wrong)


def test_neighbors_that_are_none(case):
    verify, good, neighbors, _name = case
    corners = good.shape[1]
    m = len(good)
    assert verify(neighbors=neighbors)
    for wrong, text in [
        (neighbors[1:], f"neighbors must have one row per simplex, shape ({m}, {corners}), got ({m - 1}, "),
        (neighbors[:, 1:], f"neighbors must have shape (m, {corners}), got ({m}, {corners - 1})"),
        (neighbors + m, f"neighbors name simplices {m - 1} to {neighbors.max() + m}, but there are {m}"),
        (
            neighbors - 1,
            f"neighbors name simplices -2 to {neighbors.max() - 1}, but there are {m}, and -1 for",
        ),
        (neighbors + 0.5, f"neighbors must be integers of shape (m, {corners}), got dtype float64"),
    ]:
        with pytest.raises(ValueError, match=re.escape(text)):
            verify(neighbors=wrong)


def test_duplicates_that_are_none(case):
    verify = case[0]
    assert verify(duplicates=[])
    assert verify(duplicates=np.empty((0, 2), np.int32))
    for wrong, text in [
        ([3, 4], "duplicates must have shape (k, 2), got (2,)"),
        ([[3, 20]], "duplicates name sites 3 to 20, but there are 20 points"),
        ([[-1, 3]], "duplicates name sites -1 to 3, but there are 20 points"),
        ([[0.0, 1.0]], "duplicates must be integers of shape (k, 2), got dtype float64"),
    ]:
        with pytest.raises(ValueError, match=re.escape(text)):
            verify(duplicates=wrong)


def test_a_cut_mesh_of_the_right_type_is_no_error_but_no_triangulation(case):
    verify, good, _neighbors, _name = case
    corners = good.shape[1]
    assert not verify([])
    assert not verify(np.empty((0, corners), np.int32))


@pytest.mark.parametrize(
    ("harm", "text"),
    [
        (lambda good: good.astype(np.int64) + 2**32, "there are points 0 to 19 only"),
        (lambda good: good + 0.25, "simplices should be whole numbers"),
        (lambda good: good[:, :3], "expected simplices of shape (m, 4)"),
    ],
    ids=["beyond 32 bits", "fractions", "three columns"],
)
def test_a_file_whose_indices_would_wrap_or_be_cut_off(harm, text, tmp_path, capsys):
    np.savez(tmp_path / "odd.npz", points=SPACE, simplices=harm(dt3d.Delaunay(SPACE).simplices))
    assert cli.main(["verify", str(tmp_path / "odd.npz")]) == 2
    assert text in " ".join(capsys.readouterr().err.split())

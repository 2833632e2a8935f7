"""`verify` passes what is right and names what is broken."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d import cli
from dt3d.files import write_mesh
from dt3d.verification import verify

GRID = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), -1).reshape(-1, 3)
RANDOM = np.random.default_rng(0).random((80, 3))


@pytest.mark.parametrize("points", [RANDOM, GRID, np.concatenate([GRID, GRID[:9]])])
@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
def test_results_verify(points, method):
    report = dt3d.Delaunay(points, method=method).verify()
    assert report
    assert str(report).count("holds: ") == len(report.invariants) == 7


def broken(report):
    return [what for what, count in report.invariants if count]


def verify_changed(tri, **changes):
    """What `verify` says of a result some of whose arrays are others."""
    names = ("points", "simplices", "neighbors", "duplicates")
    arrays = {name: getattr(tri, name) for name in names} | changes
    points, simplices = arrays.pop("points"), arrays.pop("simplices")
    return verify(points, simplices, perturbed=True, **arrays)


def test_what_scipy_finds_on_random_sites_verifies_once_it_is_oriented():
    simplices = scipy.spatial.Delaunay(RANDOM).simplices
    a, b, c, d = RANDOM[simplices].swapaxes(0, 1)
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    assert not verify(RANDOM, simplices) or not turned.any()
    simplices[turned] = simplices[turned][:, [1, 0, 2, 3]]
    assert verify(RANDOM, simplices)


def test_a_turned_tetrahedron():
    tri = dt3d.Delaunay(RANDOM)
    simplices = tri.simplices.copy()
    simplices[3] = simplices[3][[1, 0, 2, 3]]
    report = verify_changed(tri, simplices=simplices)
    assert "every tetrahedron is positively oriented" in broken(report)


def test_a_missing_tetrahedron():
    tri = dt3d.Delaunay(RANDOM)
    assert "the hull is closed and convex along every edge" in broken(verify(RANDOM, tri.simplices[1:]))


def test_a_tetrahedron_twice():
    tri = dt3d.Delaunay(RANDOM)
    twice = np.concatenate([tri.simplices, tri.simplices[5:6]])
    assert "every facet is shared by at most two tetrahedra" in broken(verify(RANDOM, twice))


def test_a_wrong_neighbor():
    tri = dt3d.Delaunay(RANDOM)
    neighbors = tri.neighbors.copy()
    neighbors[0, 0] += 1
    assert broken(verify_changed(tri, neighbors=neighbors)) == ["neighbors says which ones"]


def test_a_lost_site_and_a_false_duplicate():
    tri = dt3d.Delaunay(RANDOM)
    lost = verify(np.concatenate([RANDOM, [[0.5, 0.5, 0.5]]]), tri.simplices)
    assert broken(lost) == ["every site is a vertex, or a duplicate of one"]
    points = np.concatenate([RANDOM, [[0.5, 0.5, 0.5]]])
    report = verify_changed(tri, points=points, duplicates=np.array([[80, 3]]))
    assert broken(report) == ["every site is a vertex, or a duplicate of one"]


def test_a_duplicate_may_be_used_for_the_other():
    tri = dt3d.Delaunay(RANDOM)
    points = np.concatenate([RANDOM, RANDOM[:1]])
    simplices = np.where(tri.simplices == 0, 80, tri.simplices)
    assert verify(points, simplices)


def test_a_triangulation_that_is_not_delaunay():
    # five sites: two tetrahedra about a facet, whose spheres hold each other's far vertex
    points = np.array([[0, 0, 0.1], [1, 0, 0], [-0.5, 0.9, 0], [-0.5, -0.9, 0], [0, 0, -0.1]])
    two = np.array([[1, 2, 3, 0], [2, 1, 3, 4]])
    assert broken(verify(points, two)) == ["no site is inside the sphere across a facet"]
    assert len(dt3d.Delaunay(points).simplices) == 3


def test_one_split_of_a_cube_is_the_perturbed_one():
    cube = GRID[(GRID < 2).all(axis=1)]
    tri = dt3d.Delaunay(cube)
    mirror = (1 - cube) @ np.diag([1, 1, -1]) + [0, 0, 1]  # another split of the same cube
    index = [int(np.flatnonzero((cube == p).all(axis=1))[0]) for p in mirror]
    other = np.array(index)[tri.simplices]
    a, b, c, d = cube[other].swapaxes(0, 1)
    if np.linalg.det(np.stack([b - a, c - a, d - a], axis=1))[0] < 0:
        other = other[:, [1, 0, 2, 3]]
    assert verify(cube, other)
    assert broken(verify(cube, other, perturbed=True)) == ["no site is inside the sphere across a facet"]


def test_indices_out_of_range():
    with pytest.raises(ValueError, match="simplices name sites 0 to 9, but there are 5 points"):
        verify(RANDOM[:5], [[0, 1, 2, 9]])


def test_command_line(tmp_path, capsys):
    tri = dt3d.Delaunay(RANDOM)
    write_mesh(tri, tmp_path / "good.npz")
    assert cli.main(["verify", str(tmp_path / "good.npz")]) == 0
    assert "good.npz: a Delaunay triangulation" in capsys.readouterr().out.replace("\n", "")
    arrays = {name: getattr(tri, name).copy() for name in ("points", "simplices", "neighbors", "iteration")}
    arrays["simplices"][0] = arrays["simplices"][0][[1, 0, 2, 3]]
    write_mesh(SimpleNamespace(**arrays), tmp_path / "bad.npz")
    with pytest.raises(SystemExit) as caught:
        cli.main(["verify", str(tmp_path / "bad.npz")])
    assert caught.value.code == 1
    assert "broken: every tetrahedron is positively oriented" in capsys.readouterr().out

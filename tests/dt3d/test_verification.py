"""`verify` passes what is right and names what is broken."""

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
    assert str(report).count("holds: ") == len(report.invariants) == 9


def broken(report):
    return [what for what, count in report.invariants if count]


def test_orientation_of_other_peoples_meshes_is_a_remark():
    points = np.random.default_rng(0).random((200, 3))
    found = scipy.spatial.Delaunay(points)
    a, b, c, d = points[found.simplices].swapaxes(0, 1)
    turned = int((np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0).sum())
    assert turned  # mixed orientation is the rule
    report = verify(points, found.simplices, neighbors=found.neighbors)
    assert report
    remark = f"{turned} of {len(found.simplices)} simplices are negatively oriented, and were turned first"
    assert report.remarks == (remark,)
    assert str(report).endswith(f"\nremark: {remark}")


def test_a_turned_tetrahedron_of_ours_breaks_one_sentence_only():
    tri = dt3d.Delaunay(RANDOM)
    simplices = np.array(tri.simplices)
    simplices[3] = simplices[3][[1, 0, 2, 3]]
    report = verify(RANDOM, simplices, perturbed=True, oriented=True)
    assert broken(report) == ["every tetrahedron is positively oriented"]
    assert not report.remarks


def test_a_missing_tetrahedron():
    tri = dt3d.Delaunay(RANDOM)
    assert "the hull is convex along every edge" in broken(verify(RANDOM, tri.simplices[1:]))


def test_a_tetrahedron_twice():
    tri = dt3d.Delaunay(RANDOM)
    twice = np.concatenate([tri.simplices, tri.simplices[5:6]])
    report = verify(RANDOM, twice)
    assert report.invariants[2] == ("every facet has at most one tetrahedron on each side", 4)
    assert str(report).count("not checked: ") == 4


def test_a_wrong_neighbor():
    tri = dt3d.Delaunay(RANDOM)
    neighbors = np.array(tri.neighbors)
    neighbors[0, 0] += 1
    report = verify(RANDOM, tri.simplices, neighbors=neighbors)
    assert broken(report) == ["neighbors says which ones"]


def test_a_lost_site_and_a_false_duplicate():
    tri = dt3d.Delaunay(RANDOM)
    more = np.concatenate([RANDOM, [[0.5, 0.5, 0.5]]])
    lost = verify(more, tri.simplices)
    assert broken(lost) == ["every site is a vertex, or a duplicate of one"]
    false = verify(more, tri.simplices, duplicates=[[80, 3]])
    assert broken(false) == ["every site is a vertex, or a duplicate of one"]


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
    assert broken(verify(cube, other, perturbed=True)) == [
        "no site is inside the sphere across a facet, ties decided by the perturbation"
    ]


def test_indices_out_of_range():
    with pytest.raises(ValueError, match="simplices name sites 0 to 9, but there are 5 points"):
        verify(RANDOM[:5], [[0, 1, 2, 9]])


def test_command_line(tmp_path, capsys):
    tri = dt3d.Delaunay(RANDOM)
    write_mesh(tri, tmp_path / "good.npz")
    assert cli.main(["verify", str(tmp_path / "good.npz")]) == 0
    assert "good.npz: a Delaunay triangulation" in capsys.readouterr().out.replace("\n", "")
    np.savez(tmp_path / "turned.npz", points=RANDOM, simplices=tri.simplices[:, [1, 0, 2, 3]])
    assert cli.main(["verify", str(tmp_path / "turned.npz")]) == 0
    m = len(tri.simplices)
    assert f"remark: {m} of {m} simplices are negatively oriented" in capsys.readouterr().out
    np.savez(tmp_path / "bad.npz", points=RANDOM, simplices=tri.simplices[1:])
    assert cli.main(["verify", str(tmp_path / "bad.npz")]) == 1
    assert "broken: the hull is convex along every edge" in capsys.readouterr().out

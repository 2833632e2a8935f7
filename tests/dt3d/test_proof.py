"""The sentences of `verify` imply the triangulation together; each is broken alone by some mesh."""

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d.threaded2d import verify as verify2d
from dt3d.verification import verify

from .meshes import cover, facets_of, round_an_axis, slit_axis, slit_wheel, star_polygon, wheel

LOST = "every site is a vertex, or a duplicate of one"
FLAT = "no tetrahedron is flat"
POSITIVE = "every tetrahedron is positively oriented"
FACETS = "every facet has at most one tetrahedron on each side"
NEIGHBORS = "neighbors says which ones"
SPHERES = "no site is inside the sphere across a facet"
ONCE = "a point inside the first tetrahedron is in no other one"
BEHIND = "that point is behind every facet of the hull"
CONVEX = "the hull is convex along every edge"
AFTER_FACETS = [SPHERES, ONCE, BEHIND, CONVEX]

UNIT = np.concatenate([np.zeros((1, 3)), np.eye(3)])  # a tetrahedron
CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
RANDOM = np.random.default_rng(0).random((80, 3))


def broken(report):
    assert bool(report) == (not [what for what, count in report.invariants if count != 0])
    return [what for what, count in report.invariants if count]


def unchecked(report):
    return [what for what, count in report.invariants if count is None]


def in_words_of_the_plane(sentence):
    for space, plane in [
        ("tetrahedron", "triangle"),
        ("a facet", "an edge"),
        ("facet", "edge"),
        ("sphere", "circle"),
        ("along every edge", "at every vertex"),
    ]:
        sentence = sentence.replace(space, plane)
    return sentence


def both(sentences, in_space, in_the_plane):
    """Assert that these sentences, and no others, are broken by a mesh in space and by one in the plane."""
    assert broken(verify(*in_space)) == sentences
    assert broken(verify2d(*in_the_plane)) == [in_words_of_the_plane(s) for s in sentences]


def test_the_sentences_in_their_order():
    tri = dt3d.Delaunay(RANDOM)
    assert [what for what, _ in verify(RANDOM, tri.simplices).invariants] == [
        LOST,
        FLAT,
        FACETS,
        *AFTER_FACETS,
    ]
    assert [what.split(",")[0] for what, _ in tri.verify().invariants] == [
        LOST.split(",")[0], POSITIVE, FLAT, FACETS, NEIGHBORS, *AFTER_FACETS
    ]  # fmt: skip
    flat = threaded2d.Delaunay(RANDOM[:, :2])
    assert [what for what, _ in verify2d(RANDOM[:, :2], flat.triangles).invariants] == [
        in_words_of_the_plane(s) for s in (LOST, FLAT, FACETS, *AFTER_FACETS)
    ]


def test_a_lost_site_breaks_one_sentence():
    extra = [[0.1, 0.1, 0.1]]
    both(
        [LOST],
        (np.concatenate([UNIT, extra]), [[0, 1, 2, 3]]),
        (np.concatenate([UNIT[:3, :2], [[0.1, 0.1]]]), [[0, 1, 2]]),
    )


def test_a_flat_simplex_on_the_hull_breaks_one_sentence_and_the_later_ones_are_not_checked():
    tri = dt3d.Delaunay(CUBE)
    face = np.flatnonzero(CUBE[:, 2] == 0)
    report = verify(CUBE, [*tri.simplices.tolist(), face])
    assert broken(report) == [FLAT]
    assert unchecked(report) == [FACETS, *AFTER_FACETS]
    assert f"not checked: {CONVEX}" in str(report)
    line = np.array([[0, 0], [1, 0], [2, 0], [0, 1.0]])
    report = verify2d(line, [[0, 1, 3], [1, 2, 3], [0, 1, 2]])
    assert broken(report) == ["no triangle is flat"]


def test_a_vertex_that_is_twice_in_one_simplex():
    report = verify(UNIT, [[0, 1, 2, 3], [1, 2, 3, 3]])
    assert broken(report) == [FLAT]
    assert broken(verify2d(UNIT[:3, :2], [[0, 1, 2], [1, 1, 2]])) == ["no triangle is flat"]


def test_a_turned_simplex_breaks_a_sentence_only_where_orientation_is_promised():
    turned = [[1, 0, 2, 3]]
    assert broken(verify(UNIT, turned, oriented=True)) == [POSITIVE]
    report = verify(UNIT, turned)
    assert report
    assert report.remarks == ("1 of 1 simplices are negatively oriented, and were turned first",)


@pytest.mark.parametrize(
    "again", [[4, 1, 2, 3], [1, 4, 2, 3], [4, 2, 3, 1]], ids=["same", "turned", "rotated"]
)
def test_a_simplex_that_is_there_twice_breaks_one_sentence(again):
    points = np.concatenate([UNIT, [[1.0, 1, 1]]])
    report = verify(points, [[0, 1, 2, 3], [4, 1, 2, 3], again])
    assert broken(report) == [FACETS]
    assert unchecked(report) == AFTER_FACETS


def test_two_simplices_on_one_side_of_a_facet_break_one_sentence():
    points = np.concatenate([UNIT, [[1.0, 1, 1]]])
    # 0 and 4 are on opposite sides of 1, 2, 3; 3 and 4 are on one side of 0, 1, 2
    assert verify(points, [[0, 1, 2, 3], [1, 2, 3, 4]])
    both(
        [FACETS],
        (points, [[0, 1, 2, 3], [0, 1, 2, 4]]),
        (points[[0, 1, 2, 4], :2], [[0, 1, 2], [0, 1, 3]]),
    )


def test_wrong_neighbors_break_one_sentence():
    tri = dt3d.Delaunay(RANDOM)
    neighbors = np.array(tri.neighbors)
    neighbors[[3, 5]] = neighbors[[5, 3]]
    assert broken(verify(RANDOM, tri.simplices, neighbors=neighbors)) == [NEIGHBORS]


def test_neighbors_are_turned_with_their_simplices():
    tri = dt3d.Delaunay(RANDOM)
    some = np.random.default_rng(1).random(len(tri.simplices)) < 0.5
    simplices, neighbors = np.array(tri.simplices), np.array(tri.neighbors)
    simplices[some], neighbors[some] = simplices[some][:, [3, 1, 2, 0]], neighbors[some][:, [3, 1, 2, 0]]
    assert verify(RANDOM, simplices, neighbors=neighbors)
    assert broken(verify(RANDOM, simplices, neighbors=tri.neighbors)) == [NEIGHBORS]


def test_a_site_in_a_sphere_breaks_one_sentence():
    points = np.array([[0, 0, 0.1], [1, 0, 0], [-0.5, 0.9, 0], [-0.5, -0.9, 0], [0, 0, -0.1]])
    both(
        [SPHERES],
        (points, [[1, 2, 3, 0], [2, 1, 3, 4]]),
        (np.array([[-1, 0], [0, -0.1], [1, 0], [0, 0.1]]), [[0, 1, 2], [0, 2, 3]]),
    )


@pytest.mark.parametrize("height", [0.3, 0.5, 0.7])
@pytest.mark.parametrize(("corners", "step"), [(5, 2), (7, 2), (7, 3), (9, 4)])
def test_a_mesh_that_winds_often_breaks_one_sentence(corners, step, height):
    both([ONCE], round_an_axis(corners, step, height), (wheel(corners), star_polygon(corners, step)))
    assert verify(*round_an_axis(corners, 1, height), perturbed=False)
    assert verify2d(wheel(corners), star_polygon(corners, 1))
    counts = dict(verify(*round_an_axis(corners, step, height)).invariants)
    assert counts[ONCE] == step - 1


def test_a_slit_whose_sides_lie_in_one_plane_breaks_one_sentence():
    # the sides are folded onto each other, which every test of convexity along edges passes
    both([BEHIND], slit_axis(5, 0.5), slit_wheel(5))


def test_two_components_break_one_sentence():
    two = np.concatenate([UNIT, -UNIT - 10])
    both(
        [BEHIND],
        (two, [[0, 1, 2, 3], [4, 5, 6, 7]]),
        (two[[0, 1, 2, 4, 5, 6], :2], [[0, 1, 2], [3, 4, 5]]),
    )


def test_two_components_that_meet_at_a_vertex():
    two = np.concatenate([UNIT, -UNIT[1:]])
    assert broken(verify(two, [[0, 1, 2, 3], [0, 4, 5, 6]])) == [BEHIND]
    pinched = verify2d(two[[0, 1, 2, 4, 5], :2], [[0, 1, 2], [0, 3, 4]])
    assert broken(pinched) == [in_words_of_the_plane(s) for s in (BEHIND, CONVEX)]


def test_two_components_that_overlap():
    for other in (UNIT + 0.125, UNIT / 8 + 0.125, UNIT * 8 - 1, UNIT):
        points = np.concatenate([UNIT, other])
        assert not verify(points, [[0, 1, 2, 3], [4, 5, 6, 7]])
        assert not verify2d(np.delete(points[:, :2], [3, 7], axis=0), [[0, 1, 2], [3, 4, 5]])


def test_two_tetrahedra_that_meet_along_an_edge():
    points = np.concatenate([UNIT, [[-1, 0, 0], [0, -1, 0]]])
    assert broken(verify(points, [[0, 1, 2, 3], [0, 4, 5, 3]])) == [BEHIND, CONVEX]


def test_a_dent_breaks_one_sentence():
    # the head of an arrow; seen from its tip, where the point is, its border goes round once
    arrow = np.array([[0, 3], [-2, -1], [0, 0], [2, -1.0]])
    in_space = np.concatenate([np.column_stack([arrow, [-1, 0, 0, 0]]), [[0, 3, 1]]])
    both(
        [CONVEX],
        (in_space, [[0, 4, 1, 2], [0, 4, 2, 3]]),
        (arrow, [[0, 1, 2], [0, 2, 3]]),
    )


def test_an_inner_void():
    tri = dt3d.Delaunay(RANDOM)
    inner = np.flatnonzero((tri.neighbors >= 0).all(axis=1))
    assert broken(verify(RANDOM, np.delete(tri.simplices, inner[5], axis=0))) == [BEHIND, CONVEX]
    flat = threaded2d.Delaunay(RANDOM[:, :2])
    inner = np.flatnonzero((flat.neighbors >= 0).all(axis=1))
    assert not verify2d(RANDOM[:, :2], np.delete(flat.triangles, inner[5], axis=0))


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("sheets", [2, 3])
def test_covers_are_refused_however_they_branch(d, sheets):
    prove, rng = (verify2d, verify)[d - 2], np.random.default_rng(d)
    for n in np.repeat([6, 8, 12, 20], 8):
        points = rng.random((n, d))
        tri = threaded2d.Delaunay(points) if d == 2 else dt3d.Delaunay(points)
        simplices = tri.triangles if d == 2 else tri.simplices
        inner = [facet for facet, sides in facets_of(simplices).items() if len(sides) == 2]
        chosen = rng.permutation(len(inner))[: rng.integers(0, 1 + len(inner))]
        shift = {inner[i]: int(rng.integers(1, sheets)) for i in chosen}
        above, rows = cover(points, simplices, sheets, shift)
        assert len(rows) == sheets * len(simplices)
        assert not prove(above, rows)
        # no two sites are equal, and the mesh has the same shape
        assert not prove(above + rng.normal(0, 1e-9, above.shape), rows)
    assert prove(*cover(points, simplices, 1, {}))


@pytest.mark.parametrize("name", ["pentagram3d", "slit"])
def test_meshes_that_were_taken_for_triangulations(name, shared_folder):
    with np.load(shared_folder.parent / "cases" / f"{name}.npz") as mesh:
        assert not verify(mesh["points"], mesh["simplices"])


@pytest.mark.parametrize("exponent", [-1040, -500, 500, 1020])
def test_the_answer_does_not_depend_on_a_power_of_two(exponent):
    points = np.round(round_an_axis(5, 1, 0.5)[0] * 8)  # few digits, so that subnormal numbers hold them
    for step, right in ((1, True), (2, False)):
        rows = round_an_axis(5, step, 0.5)[1]
        assert bool(verify(np.ldexp(points, exponent), rows)) == right
        rim = np.ldexp(np.concatenate([[[0, 0]], points[2:, :2]]), exponent)
        assert bool(verify2d(rim, star_polygon(5, step))) == right

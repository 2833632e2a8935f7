"""What is shown of a triangulation: the cut faces the eye, faces close what is shown, slivers are peeled."""

import numpy as np
import pytest

import dt3d
from dt3d._scene import Choice, Scene, color_range, cut_direction, explained, eye, is_wide
from dt3d._topology import open_edges

RNG = np.random.default_rng(11)
POINTS = RNG.random((300, 3))
TRI = dt3d.Delaunay(POINTS)
SCENE = Scene(TRI)


def on_sphere(n):
    points = RNG.normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def test_by_default_it_is_cut_open_and_coloured_by_depth():
    choice = SCENE.chosen(Choice())
    assert (choice.scalars, choice.longest, choice.cut, choice.upto) == ("depth", np.inf, 0.5, None)
    shown = SCENE.shown(choice)
    assert 0.3 < shown.mean() < 0.7
    toward = eye(choice)[2]
    assert (SCENE.middles[shown].mean(axis=0) - SCENE.middles[~shown].mean(axis=0)) @ toward < -0.2


@pytest.mark.parametrize("azimuth", [0.0, 120.0])
def test_the_cut_follows_the_eye(azimuth):
    choice = SCENE.chosen(Choice(azimuth=azimuth, cut=0.3))
    direction = cut_direction(choice)
    assert direction @ eye(choice)[2] > 0.8
    along = SCENE.middles @ direction
    np.testing.assert_array_equal(
        SCENE.shown(choice), along <= along.max() - 0.3 * (along.max() - along.min())
    )


@pytest.mark.parametrize("cut", [0.0, 0.4])
def test_faces_close_what_is_shown_and_look_outwards(cut):
    shown = SCENE.shown(SCENE.chosen(Choice(cut=cut)))
    faces, owners = SCENE.faces(shown)
    assert open_edges(faces) == 0
    assert shown[owners].all()
    a, b, c = POINTS[faces].swapaxes(0, 1)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(TRI.volumes[shown].sum())
    if cut == 0:
        assert len(faces) == len(TRI.convex_hull)


def test_long_tetrahedra_are_peeled_where_they_fill_the_hull():
    assert SCENE.usual_longest() == np.inf
    surface = Scene(dt3d.Delaunay(on_sphere(2000)))
    choice = surface.chosen(Choice())
    edges = surface.data["longest_edge"]
    assert choice.longest == pytest.approx(5 * np.median(edges))
    assert choice.cut == 0
    shown = surface.shown(choice)
    assert surface.data["volume"][~shown].sum() > 0.5 * surface.data["volume"].sum()
    assert surface.shown(surface.chosen(Choice(longest=np.inf, cut=0))).all()
    assert surface.chosen(Choice(longest=np.inf)).cut == 0.5


def test_iterations_only_where_they_mean_something(cube):
    assert SCENE.last == 1
    assert "iteration" not in SCENE.data
    scene = Scene(cube)
    assert scene.last == 3
    assert scene.shown(scene.chosen(Choice(cut=0, upto=1))).tolist() == (cube.iteration == 1).tolist()
    # the depths of a cube are all 0, its edges all alike: what varies is shown
    assert scene.chosen(Choice()).scalars == "iteration"


@pytest.mark.parametrize(("scale", "offset"), [(1e-300, 0.0), (1e300, 0.0), (1e-3, 5e5)])
def test_points_are_in_the_unit_ball(scale, offset):
    points = POINTS[:50] * scale + offset
    scene = Scene(dt3d.Delaunay(points))
    assert np.hypot.reduce(scene.points, axis=1).max() == pytest.approx(1)
    low, high = points.min(axis=0), points.max(axis=0)
    expected = (points - low) / (high - low)
    low, high = scene.points.min(axis=0), scene.points.max(axis=0)
    np.testing.assert_allclose((scene.points - low) / (high - low), expected, atol=1e-6)
    assert 0.2 < scene.shown(scene.chosen(Choice(cut=0.5))).mean() < 0.8


def test_files_have_no_neighbors(cube):
    class File:
        points, simplices, iteration = cube.points, cube.simplices, cube.iteration

    faces, _ = Scene(File()).faces(np.ones(6, bool))
    assert len(faces) == 12
    assert open_edges(faces) == 0


def test_the_plane_is_seen_from_above():
    tri = dt3d.Delaunay(POINTS[:, :2])
    scene = Scene(tri)
    choice = scene.chosen(Choice())
    assert (choice.cut, choice.scalars) == (0, "depth")
    np.testing.assert_allclose(eye(choice), np.eye(3), atol=1e-12)
    faces, owners = scene.faces(scene.shown(choice))
    np.testing.assert_array_equal(faces, tri.simplices)
    np.testing.assert_array_equal(owners, np.arange(len(faces)))


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        (Choice(scalars="depht"), "scalars must be one of depth, longest_edge, volume, circumradius, got"),
        (Choice(scalars="iteration"), "by insertion there are no iterations"),
        (Choice(cut=1.5), "cut must be from 0"),
        (Choice(cut=float("nan")), "cut must be from 0"),
        (Choice(longest=1e-9), "leaves nothing: the longest edges are 0\\.\\d+ at least"),
        (Choice(azimuth=float("inf")), "azimuth and elevation must be finite"),
    ],
)
def test_wrong_choices_say_so(choice, message):
    with pytest.raises(ValueError, match=message):
        SCENE.chosen(choice)
    with pytest.raises(ValueError, match="nothing to show"):
        Scene(TRI.subset([]))


def test_colours_are_of_what_there_is_much_of():
    values = np.r_[1e-30, np.linspace(1.0, 2.0, 1000), 1e30]
    low, high = color_range(values)
    assert 1 <= low < 1.1
    assert 1.9 < high <= 2
    assert not is_wide(values)
    assert is_wide(np.geomspace(1, 100, 500))
    assert color_range(np.array([3, 1, 2])) == (1, 3)
    assert not is_wide(np.arange(1000))
    assert color_range(np.array([np.inf, 1.0, 2.0])) == (1, 2)
    assert all(explained(name).startswith(name.split("_")[0]) for name in SCENE.data)

"""Pictures: the painter's order is right, the options do what they say, the file has the promised size."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.image import imread
from scipy.spatial import Delaunay

from dt3d import plot
from dt3d.plot import View, draw


@pytest.mark.parametrize("seed", range(3))
def test_no_tetrahedron_hides_one_painted_later(seed):
    points = np.random.default_rng(seed).uniform(-0.5, 0.5, (300, 3))
    tri = Delaunay(points)  # an independent triangulation
    corners = points[tri.simplices]
    negative = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
    corners[negative] = corners[negative][:, [1, 0, 2, 3]]
    place = np.empty(len(corners), int)
    place[plot._back_to_front(corners)] = np.arange(len(corners))

    # of two that share a face, the one on the eye's side comes later: along any ray that fixes the order
    middle = corners.mean(axis=1)
    t, k = np.nonzero(tri.neighbors >= 0)
    u = tri.neighbors[t, k]
    shared = np.stack([np.delete(tri.simplices[i], j) for i, j in zip(t, k, strict=True)])
    a, b, c = points[shared].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    eye_side = np.einsum("ij,ij->i", normal, [0, 0, plot.EYE] - a) > 0
    nearer = (np.einsum("ij,ij->i", normal, middle[t] - a) > 0) == eye_side
    assert ((place[t] > place[u]) == nearer).all()


def test_cospherical_tetrahedra_are_ordered_too(cube):
    corners = cube.points[cube.simplices] - [0.5, 0.5, 0.5]
    distance = np.linalg.norm(corners.mean(axis=1) - [0, 0, plot.EYE], axis=1)
    assert (np.diff(distance[plot._back_to_front(corners)]) <= 1e-12).all()


def test_views_leave_out_what_they_say(cube):
    def shown(**options):
        return plot._shown(cube.points[cube.simplices] - 0.5, cube.iteration, View(**options))

    assert shown(cut=False).all()
    assert shown(cut=False, upto=1).tolist() == [True, True, True, False, False, False]
    assert shown(cut=False, longest=1.8).all()
    assert not shown(cut=False, longest=1.7).any()  # all have the diagonal, sqrt(3)
    assert 0 < shown(cut=True).sum() < 6


def test_camera_is_a_rotation():
    camera = plot.camera(View(azimuth=70, elevation=-20))
    np.testing.assert_allclose(camera @ camera.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(camera) == pytest.approx(1.0)


def test_picture_has_the_size_asked_for_and_is_not_empty(cube, tmp_path):
    draw(cube, tmp_path / "a.png", View("a cube", cut=False), width=300, height=200)
    pixels = imread(tmp_path / "a.png")
    assert pixels.shape[:2] == (200, 333)  # and a strip for the colour bar
    left = pixels[:, :300, :3].reshape(-1, 3)
    assert 0.1 < (left < 0.99).any(axis=1).mean() < 0.9
    draw(cube, tmp_path / "b.png", [View(), View(shrink=0.5)], width=300, height=200)
    assert imread(tmp_path / "b.png").shape[:2] == (200, 633)


def test_pictures_of_a_growing_set_stay_in_place(cube):
    from matplotlib.figure import Figure

    limits = []
    for upto in (1, 2, 3):
        ax = Figure().add_subplot()
        plot.paint(cube, ax, View(cut=False, upto=upto))
        limits.append((ax.get_xlim(), ax.get_ylim()))
    assert limits[0] == limits[1] == limits[2]


def test_every_front_face_of_one_tetrahedron_is_painted():
    from matplotlib.figure import Figure

    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    tri = SimpleNamespace(points=corners, simplices=np.array([[0, 1, 2, 3]]), iteration=np.array([1]))
    ax = Figure().add_subplot()
    plot.paint(tri, ax, View(cut=False))  # from where x, y and z are positive only the slanted face shows
    assert len(ax.collections[0].get_paths()) == 1


def test_errors(cube, tmp_path, monkeypatch):
    with pytest.raises(ValueError, match=r"unknown extension '\.vtu'; known are \.png, \.pdf, \.svg, \.jpg"):
        draw(cube, tmp_path / "a.vtu")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        draw(cube, tmp_path / "nowhere" / "a.png")
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ImportError, match=r"a picture needs matplotlib.*pip install 'dt3d\[view\]'"):
        draw(cube, tmp_path / "a.png")


def test_one_iteration_needs_no_scale(cube, tmp_path):
    draw(cube, tmp_path / "several.png", width=200, height=200)
    cube.iteration[:] = 1
    draw(cube, tmp_path / "one.png", width=200, height=200)
    several, one = (imread(tmp_path / name) for name in ("several.png", "one.png"))
    assert several.shape == one.shape
    bar = slice(201, None)  # columns to the right of the panel
    assert (several[:, bar, :3] < 1).any()
    assert (one[:, bar, :3] == 1).all()

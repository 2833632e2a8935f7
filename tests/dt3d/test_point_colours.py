"""`dt3d view` colours by data of the points: in pictures, in windows and on pages."""

import gzip
import json
import re
from base64 import b64decode
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.image import imread

import dt3d
from dt3d import cli
from dt3d._display import renders
from dt3d._mesh_plane import write_plane_mesh
from dt3d._page import write_page
from dt3d._scene import Choice, Scene
from dt3d._window import Window
from dt3d.files import read_mesh, write_mesh

from .windows import browse, browser

N = 300
POINTS = np.random.default_rng(4).random((N, 3))
TRI = dt3d.Delaunay(POINTS)
DATA = {
    "temperature": 1 + POINTS[:, 0].astype(np.float32),
    "depth": np.arange(N),
    "velocity": POINTS - 0.5,
    "on": POINTS[:, 1] > 0.5,
    "same": np.ones(N),
}
SCENE = Scene(
    SimpleNamespace(points=POINTS, simplices=TRI.simplices, neighbors=TRI.neighbors, point_data=DATA)
)
WARM = Choice("temperature")

opengl = pytest.mark.skipif(not renders(), reason="there is no OpenGL library")
in_browser = pytest.mark.skipif(browser() is None, reason="there is no browser here, or none that runs")


@pytest.fixture
def mesh(tmp_path):
    write_mesh(TRI, tmp_path / "mesh.vtu", point_data=DATA)
    return tmp_path / "mesh.vtu"


def view(*words):
    return cli.main(["view", *map(str, words)])


def packed(page):
    """The arrays of a page by name, and what its program is told."""
    text = page.read_text()
    about = json.loads(re.search(r'type="application/json">(.*?)</script>', text, re.DOTALL)[1])
    data = gzip.decompress(b64decode(re.search(r'type="text/plain">(.*?)</script>', text, re.DOTALL)[1]))
    found = {
        part["name"]: np.frombuffer(data, part["type"], part["length"], part["offset"])
        for part in about["arrays"]
    }
    return found, about


def test_a_scene_has_numbers_of_points():
    assert list(SCENE.point_data) == ["temperature", "depth of points", "velocity", "on", "same"]
    np.testing.assert_array_equal(SCENE.values("depth of points"), DATA["depth"])
    np.testing.assert_allclose(SCENE.values("velocity"), np.linalg.norm(DATA["velocity"], axis=1))
    assert SCENE.values("on").dtype == np.uint8
    assert SCENE.names[-4:] == ["temperature", "depth of points", "velocity", "on"]
    assert len(SCENE.values("depth")) == len(TRI.simplices)
    assert SCENE.chosen(Choice()).scalars == "depth"
    assert SCENE.chosen(WARM).scalars == "temperature"
    with pytest.raises(ValueError, match="one of depth, .*, temperature, depth of points, .*, got 'heat'"):
        SCENE.chosen(Choice("heat"))


def test_text_and_what_is_not_of_all_points_is_no_colour():
    data = {"name": np.array(["a"] * N), "short": np.ones(N - 1), "none": np.ones((N, 0))}
    assert Scene(SimpleNamespace(points=POINTS, simplices=TRI.simplices, point_data=data)).point_data == {}


@pytest.mark.parametrize("extension", [".vtu", ".vtk", ".npz", ".msh"])
def test_meshes_from_files_have_point_data(tmp_path, extension):
    path = tmp_path / f"mesh{extension}"
    write_mesh(TRI, path, point_data=DATA)
    found = read_mesh(path)
    np.testing.assert_array_equal(found.simplices, TRI.simplices)
    for name, values in DATA.items():
        np.testing.assert_array_equal(found.point_data[name], values)


@opengl
@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("extension", [".vtu", ".npz"])
def test_pictures(tmp_path, plane, extension):
    path = tmp_path / f"mesh{extension}"
    if plane:
        write_plane_mesh(dt3d.Delaunay(POINTS[:, :2]), path, point_data=DATA)
    else:
        write_mesh(TRI, path, point_data=DATA)
    assert (
        view(
            path,
            "--scalar",
            "temperature",
            "--cut",
            "0",
            "--azimuth",
            "-90",
            "--screenshot",
            tmp_path / "a.png",
        )
        == 0
    )
    picture = imread(tmp_path / "a.png")[:, :, :3]
    inner = picture[200:1000, :1000]  # without text and the bar
    coloured = np.ptp(inner, axis=2) > 0.15
    warm = coloured & (inner[:, :, 0] > inner[:, :, 2])  # yellow and green, where violet is cold
    # the eye is at negative y, so x and with it the temperature grow to the right
    assert np.argwhere(warm)[:, 1].mean() > np.argwhere(coloured)[:, 1].mean() + 100
    # colours change along a face, and do not jump from one to the next
    assert len(np.unique((inner[coloured] * 255).astype(int), axis=0)) > 3000


@opengl
def test_a_window_has_a_key_for_each(mesh):
    window = Window(SCENE, SCENE.chosen(Choice()), off_screen=True)
    try:
        window.press(str(window.names.index("temperature") + 1))
        assert window.choice.scalars == "temperature"
        assert window.plotter.mapper.GetScalarModeAsString() == "UsePointData"
        assert "temperature: of each point" in window.plotter.renderer.actors["count"].GetInput()
        window.press("1")
        assert window.plotter.mapper.GetScalarModeAsString() == "UseCellData"
    finally:
        window.plotter.close()


def test_a_window_has_keys_for_nine(mesh):
    many = {f"of{k}": POINTS[:, 0] * k for k in range(1, 20)}
    scene = Scene(SimpleNamespace(points=POINTS, simplices=TRI.simplices, point_data=many))
    assert len(scene.names) > 20
    write_page(scene, scene.chosen(Choice("of19")), mesh.with_suffix(".html"))
    assert len(packed(mesh.with_suffix(".html"))[1]["scalars"]) == len(scene.names)


def test_a_page_has_levels_of_points(tmp_path):
    write_page(SCENE, SCENE.chosen(WARM), tmp_path / "a.html")
    arrays, about = packed(tmp_path / "a.html")
    assert about["first"]["scalar"] == "temperature"
    assert about["scalars"]["temperature"]["title"] == "temperature"
    assert "same" not in about["scalars"]
    levels = arrays["at temperature"]
    assert (len(levels), levels.dtype) == (N, np.uint8)
    inner = np.abs(POINTS[:, 0] - 0.5) < 0.4
    np.testing.assert_allclose(levels[inner] / 255, POINTS[inner, 0], atol=0.05)


@in_browser
def test_a_page_draws_them(tmp_path):
    write_page(SCENE, SCENE.chosen(Choice("temperature", cut=0.0, azimuth=-90.0)), tmp_path / "a.html")
    browse(tmp_path / "a.html", tmp_path / "profile", f"--screenshot={tmp_path / 'a.png'}")
    inner = imread(tmp_path / "a.png")[120:680, 100:800, :3]
    coloured = np.ptp(inner, axis=2) > 0.15
    warm = coloured & (inner[:, :, 0] > inner[:, :, 2])
    assert np.argwhere(warm)[:, 1].mean() > np.argwhere(coloured)[:, 1].mean() + 50
    assert len(np.unique((inner[coloured] * 255).astype(int), axis=0)) > 1000
    dom = browse(tmp_path / "a.html", tmp_path / "profile", "--dump-dom", hash="#scalar=velocity")
    assert 'data-scalar="velocity"' in dom


def test_a_page_of_a_file(mesh, tmp_path, capsys):
    assert view(mesh, "--scalar", "velocity", "--html", tmp_path / "a.html") == 0
    assert packed(tmp_path / "a.html")[1]["first"]["scalar"] == "velocity"
    assert view(mesh, "--scalar", "heat", "--html", tmp_path / "a.html") == 2
    assert "temperature, depth of points, velocity, on, same, got 'heat'" in capsys.readouterr().err


def test_broken_data_of_a_mesh(mesh, tmp_path, capsys):
    mesh.write_bytes(
        mesh.read_bytes().replace(b'Name="temperature"', b'Name="temperature" NumberOfComponents="2"')
    )
    assert view(mesh, "--html", tmp_path / "a.html") == 2
    assert "array 'temperature' is damaged" in capsys.readouterr().err
    assert cli.main(["verify", str(mesh)]) == 0  # which needs none of them

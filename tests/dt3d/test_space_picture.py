"""Pictures in files: rendered where OpenGL is, painted where it is not."""

import importlib.util
import os
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.image import imread

import dt3d
from dt3d import _space_picture
from dt3d._display import renders
from dt3d._mesh_plane import draw_plane
from dt3d._scene import Choice
from dt3d._space_picture import HEIGHT, WIDTH, Panel, draw_picture
from dt3d.files import write_mesh

opengl = pytest.mark.skipif(not renders(), reason="VTK cannot render here")

POINTS = np.random.default_rng(2).random((400, 3))
TRI = dt3d.Delaunay(POINTS)


def colours(picture):
    """Where a picture has colours, not grey."""
    return (picture.max(axis=2) - picture.min(axis=2)) > 0.2


@opengl
def test_a_picture_uses_its_canvas(tmp_path):
    draw_picture(TRI, tmp_path / "a.png")
    picture = imread(tmp_path / "a.png")[:, :, :3]
    assert picture.shape == (HEIGHT, WIDTH, 3)
    body = colours(picture)
    rows, columns = np.flatnonzero(body.any(axis=1)), np.flatnonzero(body.any(axis=0))
    tall, wide = np.ptp(rows) / HEIGHT, np.ptp(columns[columns < 0.84 * WIDTH]) / WIDTH
    assert max(tall / 0.86, wide / 0.81) > 0.9  # between the lines, beside the bar
    assert (picture[[0, -1]] == 1).all()
    assert body[:, int(0.86 * WIDTH) :].any()  # the bar
    assert len(np.unique((picture[body] * 8).astype(int), axis=0)) > 20


@opengl
def test_two_panels_under_a_headline(tmp_path):
    panels = [Panel(Choice(scalars="volume"), "one", "of it"), Panel(Choice(cut=0.0), "another")]
    draw_picture(TRI, tmp_path / "a.jpg", panels, "both")
    picture = imread(tmp_path / "a.jpg") / 255
    assert picture.shape[1] == 2 * WIDTH
    assert picture.shape[0] > HEIGHT
    assert all(colours(half).mean() > 0.2 for half in np.split(picture, 2, axis=1))


@opengl
def test_choices_are_seen(tmp_path):
    found = {}
    for name, choice in {
        "usual": Choice(),
        "whole": Choice(cut=0.0),
        "behind": Choice(azimuth=200.0),
        "volume": Choice(scalars="volume"),
        "short": Choice(longest=0.3),
    }.items():
        draw_picture(TRI, tmp_path / "a.png", [Panel(choice)])
        found[name] = imread(tmp_path / "a.png")[::4, ::4, :3]
    names = sorted(found)
    for k, one in enumerate(names):
        for other in names[k + 1 :]:
            assert np.abs(found[one] - found[other]).mean() > 0.01, (one, other)


@opengl
def test_the_plane(tmp_path):
    draw_picture(dt3d.Delaunay(POINTS[:, :2]), tmp_path / "a.png")
    assert colours(imread(tmp_path / "a.png")[:, :, :3]).mean() > 0.3
    draw_picture(dt3d.Delaunay(POINTS[:, :2]), tmp_path / "a.svg")
    assert (tmp_path / "a.svg").read_text().count("<path") > 400


@opengl
def test_triangles_of_one_thread_are_not_of_one_colour(tmp_path):
    draw_plane(dt3d.Delaunay(POINTS[:, :2], threads=1), tmp_path / "a.png")
    picture = imread(tmp_path / "a.png")[:, :, :3]
    assert len(np.unique((picture[colours(picture)] * 8).astype(int), axis=0)) > 10


@opengl
def test_a_dead_screen_does_not_matter_and_says_nothing(tmp_path):
    write_mesh(TRI, tmp_path / "a.npz")
    words = [sys.executable, "-m", "dt3d", "view", tmp_path / "a.npz", "--screenshot", tmp_path / "a.png"]
    done = subprocess.run(words, env=os.environ | {"DISPLAY": ":4711"}, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("wrote ")


def test_vectors_are_painted(tmp_path, caplog, monkeypatch):
    monkeypatch.setattr(_space_picture, "renders", None)  # not asked
    draw_picture(TRI, tmp_path / "a.svg")
    assert (tmp_path / "a.svg").read_text().count("<path") > 400
    assert not caplog.records


@pytest.mark.parametrize("missing", ["OpenGL", "PyVista"])
def test_without_opengl_it_is_painted_and_says_so(tmp_path, caplog, monkeypatch, missing):
    monkeypatch.setattr(_space_picture, "renders", lambda: False)
    if missing == "PyVista":
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    panels = [Panel(title="one"), Panel(Choice(cut=0.0, longest=0.5), "another")]
    draw_picture(TRI, tmp_path / "a.png", panels)
    picture = imread(tmp_path / "a.png")[:, :, :3]
    assert colours(picture).mean() > 0.2
    # by insertion all iterations are 1: depths are shown, not one flat colour
    assert len(np.unique((picture[colours(picture)] * 4).astype(int), axis=0)) > 8
    (line,) = caplog.messages
    assert missing in line
    assert "painted by matplotlib" in line


def test_wrong_paths_and_choices(tmp_path):
    with pytest.raises(ValueError, match=r"unknown extension '\.gif'; known are \.png, \.pdf, \.svg, \.jpg"):
        draw_picture(TRI, tmp_path / "a.gif")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        draw_picture(TRI, tmp_path / "nowhere" / "a.png")
    with pytest.raises(ValueError, match="cut must be from 0"):
        draw_picture(TRI, tmp_path / "a.png", [Panel(Choice(cut=2.0))])
    assert not list(tmp_path.iterdir())

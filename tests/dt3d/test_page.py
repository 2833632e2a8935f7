"""The page for browsers: it has all it needs, draws, and its controls act; in a browser without a window."""

import html
import json
import re

import numpy as np
import pytest
from matplotlib.image import imread

import dt3d
from dt3d import _page
from dt3d._page import check_page_path, write_page
from dt3d._scene import Choice, Scene

from .windows import browse, browser

POINTS = np.random.default_rng(8).random((400, 3))
TRI = dt3d.Delaunay(POINTS)
SCENE = Scene(TRI)
FIRST = SCENE.chosen(Choice())

in_browser = pytest.mark.skipif(browser() is None, reason="there is no browser here, or none that runs")


def told(path):
    """What the page's program is told."""
    text = re.search(
        r'<script id="about" type="application/json">(.*?)</script>', path.read_text(), re.DOTALL
    )
    return json.loads(text[1])


def reported(path, folder, hash=""):
    """What the page says of itself when it is drawn: the attributes of its body."""
    dom = browse(path, folder / "profile", "--dump-dom", hash=hash)
    body = re.search(r"<body([^>]*)>", dom)[1]
    found = {name: html.unescape(value) for name, value in re.findall(r'data-([\w-]+)="([^"]*)"', body)}
    assert "error" not in found, found
    assert found["drawn"] == found["faces"]
    return found


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "a.html"
    write_page(SCENE, FIRST, path, "a <set> & more")
    return path


def test_a_page_has_all_it_needs(page):
    text = page.read_text()
    assert "://" not in text  # nor is there a colon in what is packed
    assert not re.search(r"\bsrc\s*=|\bimport\b|<link|@import|url\(|fetch\(|XMLHttp", text)
    assert "default-src 'none'" in text
    assert "<title>a &lt;set&gt; &amp; more</title>" in text
    assert not re.search(r"@(title|about|packed)@", text)


def test_what_the_page_is_told(page, cube):
    about = told(page)
    assert list(about["scalars"]) == ["depth", "longest_edge", "volume", "circumradius"]
    assert about["last"] == 1
    assert about["first"] | {"cut": 0.5, "scalar": "depth", "azimuth": 35.0} == about["first"]
    labels = about["scalars"]["depth"]["labels"]
    assert (labels[0], labels[-1]) == (str(SCENE.data["depth"].max()), "0")
    write_page(Scene(cube), Scene(cube).chosen(Choice()), page.parent / "cube.html")
    about = told(page.parent / "cube.html")
    assert about["last"] == 3
    assert list(about["scalars"]) == ["iteration"]  # nothing else varies


def test_large_sets_are_shown_around_the_middle(tmp_path, monkeypatch):
    monkeypatch.setattr(_page, "MOST_CELLS", 1000)
    lines = write_page(SCENE, FIRST, tmp_path / "a.html")
    assert lines[0] == f"the page has 1,000 of {len(TRI.simplices):,} tetrahedra: those around the middle"
    about = told(tmp_path / "a.html")
    assert about["simplices"] == 1000
    assert about["left"] == lines[0]
    rows = _page._rows(SCENE)
    off = np.abs(SCENE.middles - SCENE.middles.mean(axis=0)).max(axis=1)
    assert off[rows].mean() < np.delete(off, rows).mean()
    neighbors = _page._arrays(SCENE, rows)["neighbors"].reshape(-1, 4)
    t, k = np.nonzero(neighbors >= 0)
    np.testing.assert_array_equal(rows[neighbors[t, k]], TRI.neighbors[rows[t], k])


def test_colours_are_those_of_matplotlib():
    from matplotlib import colormaps

    table = np.frombuffer(_page._colors(), np.uint8).reshape(256, 3) / 255
    assert np.abs(table - colormaps["viridis"](np.linspace(0, 1, 256))[:, :3]).max() < 0.03


def test_wrong_paths(tmp_path):
    with pytest.raises(ValueError, match=r"unknown extension '\.png'; known are \.html, \.htm"):
        check_page_path(tmp_path / "a.png")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        write_page(SCENE, FIRST, tmp_path / "nowhere" / "a.html")


@in_browser
def test_the_page_draws(page, tmp_path):
    browse(page, tmp_path / "profile", f"--screenshot={tmp_path / 'a.png'}")
    picture = imread(tmp_path / "a.png")[:, :, :3]
    inner = picture[120:680, 100:800]  # without text, bar and sliders
    colours = (inner.max(axis=2) - inner.min(axis=2)) > 0.2
    assert 0.2 < colours.mean() < 0.95
    assert len(np.unique((inner[colours] * 8).astype(int), axis=0)) > 20
    # it fits between the lines above, the sliders below and the bar
    assert (picture[110:680, [0, -1]] == 1).all()
    part = picture[:690, 100:800]
    (rows,) = np.nonzero((np.ptp(part, axis=2) > 0.2).any(axis=1))
    assert 60 < rows[0] < 150
    assert rows[-1] > 600


@in_browser
@pytest.mark.parametrize(
    ("hash", "choice"),
    [
        ("", Choice()),
        ("#cut=0", Choice(cut=0.0)),
        ("#cut=0.3&scalar=volume&azimuth=100&elevation=-10", Choice("volume", None, 0.3, None, 100.0, -10.0)),
        ("#longest=0.3", Choice(longest=0.3)),
        ("#cut=7&scalar=nonsense&longest=x", Choice()),
    ],
)
def test_controls_show_what_python_shows(page, tmp_path, hash, choice):
    found = reported(page, tmp_path, hash)
    choice = SCENE.chosen(choice)
    shown = SCENE.shown(choice)
    # in single precision a middle may lie on the other side of the cut
    assert abs(int(found["shown"]) - shown.sum()) <= 1
    assert abs(int(found["faces"]) - len(SCENE.faces(shown)[0])) <= 4
    assert found["scalar"] == choice.scalars


@in_browser
def test_sliders_keys_and_the_mouse_act(page, tmp_path):
    acts = """
    <script>
      const told = {};
      const note = name => told[name] = { ...document.body.dataset, azimuth: eye.azimuth, zoom: eye.zoom };
      const slide = (id, value) => { $(id).value = value; $(id).dispatchEvent(new Event("input")); };
      const press = key => dispatchEvent(new KeyboardEvent("keydown", { key }));
      const mouse = (type, clientX, clientY) =>
        $("view").dispatchEvent(new PointerEvent(type, { clientX, clientY, pointerId: 1 }));
      const wait = setInterval(() => {
        if (!document.body.dataset.drawn) return;
        clearInterval(wait);
        $("view").setPointerCapture = () => {};
        note("first");
        slide("cut", 0); note("whole");
        slide("longest", 500); note("peeled");
        slide("scalar", "volume"); note("coloured");
        press("2"); note("pressed");
        mouse("pointerdown", 100, 100); mouse("pointermove", 150, 100); mouse("pointerup", 150, 100);
        $("view").dispatchEvent(new WheelEvent("wheel", { deltaY: -100 })); note("turned");
        press("c"); slide("cut", 0.5); note("faced");
        $("back").click(); note("back");
        const out = document.createElement("pre");
        out.id = "told"; out.textContent = JSON.stringify(told);
        document.body.append(out);
      }, 50);
    </script></body>"""
    path = tmp_path / "acted.html"
    path.write_text(page.read_text().replace("</body>", acts))
    dom = browse(path, tmp_path / "profile", "--dump-dom")
    told = json.loads(html.unescape(re.search(r'<pre id="told">(.*?)</pre>', dom)[1]))
    shown = {name: int(values["shown"]) for name, values in told.items()}
    assert shown["whole"] == len(TRI.simplices)
    assert 0 < shown["peeled"] < shown["whole"]
    assert [told[name]["scalar"] for name in ("first", "coloured", "pressed")] == [
        "depth",
        "volume",
        "longest_edge",
    ]
    assert told["turned"]["azimuth"] == told["first"]["azimuth"] - 20
    assert told["turned"]["zoom"] > told["pressed"]["zoom"]
    assert shown["faced"] < shown["peeled"]
    assert told["back"]["shown"] == told["first"]["shown"]
    assert told["back"]["scalar"] == "depth"


@in_browser
def test_the_plane_and_iterations(tmp_path, cube):
    scene = Scene(dt3d.Delaunay(POINTS[:, :2]))
    write_page(scene, scene.chosen(Choice()), tmp_path / "plane.html")
    found = reported(tmp_path / "plane.html", tmp_path, "#scalar=area")
    assert int(found["shown"]) == int(found["faces"]) == len(scene.simplices)
    scene = Scene(cube)
    write_page(scene, scene.chosen(Choice()), tmp_path / "cube.html")
    assert (
        int(reported(tmp_path / "cube.html", tmp_path, "#cut=0&upto=1")["shown"])
        == (cube.iteration == 1).sum()
    )

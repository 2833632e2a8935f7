"""The window: sliders and keys change what is shown, Ctrl-C ends it, a dead screen is an error."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import dt3d
from dt3d import _window
from dt3d._display import renders
from dt3d._scene import Choice, Scene
from dt3d._window import Window
from dt3d.files import write_mesh

from .windows import screen

opengl = pytest.mark.skipif(not renders(), reason="VTK cannot render here")

TRI = dt3d.Delaunay(np.random.default_rng(6).random((300, 3)))


@pytest.fixture
def window():
    scene = Scene(TRI)
    made = Window(scene, scene.chosen(Choice()), off_screen=True)
    yield made
    made.plotter.close()


def drag(slider, value):
    slider.GetRepresentation().SetValue(value)
    slider.InvokeEvent("InteractionEvent")


@opengl
def test_it_opens_on_the_inside(window):
    assert window.choice.cut == 0.5
    assert window.mesh.n_cells == len(window.scene.faces(window.scene.shown(window.choice))[0])
    away = np.subtract(window.plotter.camera.position, window.plotter.camera.focal_point)
    assert away @ window.mesh.cell_centers().points.mean(axis=0) < 0  # the whole has its middle at 0
    text = window.plotter.renderer.actors
    shown = window.scene.shown(window.choice).sum()
    assert f"{shown:,} of {len(TRI.simplices):,} tetrahedra; depth" in text["count"].GetInput()
    assert "drag the mesh to turn it, the sliders to cut and peel it" in text["how"].GetInput()
    assert "2 longest edge" in text["how"].GetInput()


@opengl
def test_sliders(window):
    found = window.sliders
    assert list(found) == ["cut", "longest edge"]  # by insertion iterations mean nothing
    before = window.mesh.n_cells
    drag(found["cut"], 0.0)
    assert window.choice.cut == 0
    assert window.mesh.n_cells == len(TRI.convex_hull) != before
    drag(found["longest edge"], np.log10(0.3))
    assert window.choice.longest == pytest.approx(0.3)
    edges = window.scene.data["longest_edge"]
    assert (
        f"{(edges <= window.choice.longest).sum():,} of" in window.plotter.renderer.actors["count"].GetInput()
    )
    assert found["longest edge"].GetRepresentation().GetLabelFormat() == "0.3"
    drag(found["longest edge"], np.log10(edges.max()))
    assert window.choice.longest == np.inf
    drag(found["cut"], 1.0)  # what would be left is one simplex, or none: then all stays
    assert window.mesh.n_cells > 0
    assert window.error is None


@opengl
def test_a_slider_for_iterations_of_an_extrapolation(cube):
    scene = Scene(cube)
    window = Window(scene, scene.chosen(Choice(cut=0.0)), off_screen=True)
    found = window.sliders
    assert "up to iteration" in found
    drag(found["up to iteration"], 1.0)
    assert window.choice.upto == 1
    assert window.scene.shown(window.choice).sum() == (cube.iteration == 1).sum()
    window.plotter.close()


@opengl
def test_keys(window):
    assert [bar.strip() for bar in window.plotter.scalar_bars.keys()] == ["depth"]  # noqa: SIM118
    window.press("3")
    assert window.choice.scalars == "volume"
    assert [bar.strip() for bar in window.plotter.scalar_bars.keys()] == ["volume"]  # noqa: SIM118
    assert window.plotter.mapper.array_name == "volume"
    window.press("9")
    assert window.choice.scalars == "volume"
    window.plotter.camera.position = np.add(window.plotter.camera.focal_point, [0.0, -5.0, 0.0])
    window.press("c")
    assert window.choice.azimuth == pytest.approx(-90)
    assert window.choice.elevation == pytest.approx(0, abs=1e-6)
    window.press("e")
    assert not window.edges
    window.press("r")
    window.press("x")
    assert window.open
    window.press("q")
    assert not window.open


@opengl
def test_it_hears_keys_and_the_end(window):
    window.plotter.show(interactive_update=True, auto_close=False)
    window._listen()
    interactor = window.plotter.iren.interactor
    interactor.SetKeySym("2")
    interactor.InvokeEvent("KeyPressEvent")
    assert window.choice.scalars == "longest_edge"
    assert window.open
    interactor.InvokeEvent("ExitEvent")  # of the button that closes windows
    assert not window.open


@opengl
def test_what_goes_wrong_in_a_callback_ends_it(window):
    def fail(*_):
        raise KeyboardInterrupt

    window._guarded(fail)()
    with pytest.raises(KeyboardInterrupt):
        window.run()
    assert window.plotter._closed


def test_without_a_screen_nothing_is_opened(monkeypatch):
    monkeypatch.setattr(_window, "Window", None)
    monkeypatch.setattr(_window, "check_screen", lambda: (_ for _ in ()).throw(ValueError("no screen")))
    scene = Scene(TRI)
    with pytest.raises(ValueError, match="no screen"):
        _window.show(scene, scene.chosen(Choice()))
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"a window needs PyVista.*pip install 'dt3d\[view\]'"):
        _window.show(scene, scene.chosen(Choice()))


def test_ctrl_c_ends_a_window_that_shows_the_mesh(tmp_path):
    write_mesh(TRI, tmp_path / "a.npz")
    (tmp_path / "screen").mkdir()
    with screen(tmp_path / "screen") as shown:
        process = subprocess.Popen(
            [sys.executable, "-m", "dt3d", "view", str(tmp_path / "a.npz")],
            env=os.environ | {"DISPLAY": shown.name, "LIBGL_ALWAYS_SOFTWARE": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            while process.poll() is None:
                picture = shown.picture().astype(int)
                if (np.ptp(picture, axis=2) > 50).mean() > 0.1:
                    break
                time.sleep(0.1)
            assert process.poll() is None, process.communicate()
            process.send_signal(signal.SIGINT)
            out, errors = process.communicate()
        finally:
            process.kill()
    assert (process.returncode, out, errors) == (130, "", "interrupted\n")

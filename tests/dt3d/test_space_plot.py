"""Triangulations in space on plotters of PyVista, rendered off screen."""

import sys

import matplotlib.image
import numpy as np
import pytest
import pyvista

import dt3d

RNG = np.random.default_rng(5)
POINTS = RNG.random((150, 3))
TRI = dt3d.Delaunay(POINTS)


def drawn(plotter):
    """The only mesh of a plotter, which is closed."""
    (mesh,) = plotter.meshes
    plotter.close()
    return mesh


def test_the_picture_shows_depths_on_white(tmp_path):
    plotter = TRI.plot(screenshot=tmp_path / "a.png", window_size=(400, 300))
    assert plotter.off_screen
    assert list(plotter.scalar_bars.keys()) == ["depth\n"]
    plotter.close()
    picture = matplotlib.image.imread(tmp_path / "a.png")[:, :, :3]
    assert picture.shape == (300, 400, 3)
    assert (picture[0] == 1).all()  # white margin
    body = (picture.max(axis=2) - picture.min(axis=2)) > 0.2  # colours, not grey
    assert 0.1 < body.mean() < 0.9
    assert len(np.unique((picture[body] * 8).astype(int), axis=0)) > 10


def test_what_lies_before_the_middle_is_left_out():
    whole, half = (drawn(TRI.plot(cut=cut, shrink=1, off_screen=True)) for cut in (False, True))
    assert whole.n_cells == len(TRI.simplices)
    assert 0.3 * whole.n_cells < half.n_cells < 0.7 * whole.n_cells
    eye = np.radians(35), np.radians(22)
    towards = np.array([np.cos(eye[1]) * np.cos(eye[0]), np.cos(eye[1]) * np.sin(eye[0]), np.sin(eye[1])])
    assert (half.cell_centers().points.mean(axis=0) - 0.5) @ towards < -0.05
    assert (half.cell_data["depth"] == TRI.to_pyvista()["depth"][half["vtkOriginalCellIds"]]).all()


def test_the_camera_looks_from_the_side_that_is_cut():
    plotter = TRI.plot(off_screen=True)
    position, focus, up = plotter.camera_position
    away = np.subtract(position, focus)
    away /= np.linalg.norm(away)
    expected = np.radians([35, 22])
    np.testing.assert_allclose([np.arctan2(away[1], away[0]), np.arcsin(away[2])], expected, atol=1e-6)
    assert np.dot(up, [0, 0, 1]) > 0.9
    plotter.close()


def test_long_tetrahedra_are_peeled_off():
    longest = 0.4
    mesh = drawn(TRI.plot(longest=longest, cut=False, off_screen=True))
    edges = TRI.to_pyvista().cell_data["longest_edge"]
    assert mesh.n_cells == (edges <= longest).sum()
    with pytest.raises(
        ValueError, match=r"longest=0\.001 leaves no tetrahedra: the longest edges are 0\.\d+ at"
    ):
        TRI.plot(longest=0.001)


@pytest.mark.parametrize("shrink", [0.5, 1])
def test_tetrahedra_are_shrunk(shrink):
    mesh = drawn(TRI.plot(shrink=shrink, cut=False, off_screen=True))
    assert mesh.volume == pytest.approx(shrink**3 * TRI.volumes.sum(), rel=1e-5)
    for wrong in (0, 1.5, -1):
        with pytest.raises(ValueError, match="shrink must be above 0 and at most 1"):
            TRI.plot(shrink=wrong)


def test_colours_of_cells_and_of_the_points_of_a_source():
    cloud = pyvista.PolyData(POINTS)
    cloud["height"] = POINTS[:, 2]
    cloud["depth"] = -POINTS[:, 2]  # the name of cell data, too
    for name, of in (("height", "point"), ("depth", "cell")):
        plotter = TRI.plot(scalars=name, source=cloud, off_screen=True, colormap="plasma")
        assert (plotter.mapper.array_name, plotter.mapper.scalar_map_mode) == (name, of)
        plotter.close()
    with pytest.raises(
        ValueError, match="got 'heigth'; there are volume, longest_edge, circumradius, depth$"
    ):
        TRI.plot(scalars="heigth")
    with pytest.raises(ValueError, match="by insertion all iterations are 1"):
        TRI.plot(scalars="iteration")
    with pytest.raises(ValueError, match="source has 149 points"):
        TRI.plot(source=pyvista.PolyData(POINTS[1:]))


def test_data_that_do_not_vary_have_one_colour_and_no_bar():
    one = dt3d.Delaunay(np.vstack([np.zeros(3), np.eye(3)]))
    plotter = one.plot(off_screen=True)  # all of it is before the middle, or nothing
    assert len(plotter.scalar_bars) == 0
    assert drawn(plotter).n_cells == 1


def test_integers_have_a_colour_each():
    plotter = TRI.plot(off_screen=True)
    depth = TRI.to_pyvista()["depth"]
    table = plotter.mapper.lookup_table
    assert table.n_values == depth.max() + 1
    assert table.scalar_range == (-0.5, depth.max() + 0.5)
    plotter.close()


def test_parts_are_plotted():
    part = TRI.subset(TRI.volumes < np.median(TRI.volumes))
    assert drawn(part.plot(cut=False, off_screen=True)).n_cells == len(part.simplices)
    with pytest.raises(ValueError, match="nothing to plot"):
        TRI.subset([]).plot()


def test_a_screenshot_that_cannot_be_written(tmp_path):
    with pytest.raises(ValueError, match=r"unknown extension '\.docx'; known are \.png, \.jpg"):
        TRI.plot(screenshot=tmp_path / "a.docx")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        TRI.plot(screenshot=tmp_path / "nowhere" / "a.png")


def test_options_of_the_other_dimension():
    plane = dt3d.Delaunay(POINTS[:, :2])
    with pytest.raises(ValueError, match="longest goes with triangulations in space"):
        plane.plot(longest=1)
    with pytest.raises(ValueError, match="ax goes with triangulations in the plane"):
        TRI.plot(plane.plot())
    for tri in (plane, TRI):
        with pytest.raises(TypeError, match=r"plot\(\) has no option 'shrnk'; did you mean 'shrink'\?"):
            tri.plot(shrnk=1)


def test_without_pyvista_it_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"a plot in space needs PyVista.*pip install 'dt3d\[view\]'"):
        TRI.plot()

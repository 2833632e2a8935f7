"""`dt3d triangulate` and `verify` in the plane: what is planar, options that go together, files."""

import re
from functools import cache

import numpy as np
import pytest

import dt3d
from dt3d import cli, threaded2d
from dt3d._mesh_plane import WRITERS, write_plane_mesh
from dt3d.files import read_points
from dt3d.reading.plane import read_plane_mesh

from .families import canonical

POINTS = np.vstack([np.random.default_rng(0).random((40, 2)), [[0.5, 0.25], [0.5, 0.25]]])


@cache
def _triangles():
    return canonical(threaded2d.Delaunay(POINTS).triangles)


def _csv(path, points, header=None):
    lines = [] if header is None else [header]
    lines += [",".join(repr(x) for x in row) for row in points.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def _main(*words):
    return cli.main([str(word) for word in words])


@pytest.mark.parametrize("header", [None, "x,y", "id,X,Y"])
def test_two_columns_are_triangulated_in_the_plane(tmp_path, capsys, header):
    rows = POINTS if header != "id,X,Y" else np.column_stack([np.arange(len(POINTS)), POINTS])
    source = _csv(tmp_path / "points.csv", rows, header)
    assert _main("triangulate", source, "-o", tmp_path / "out.npz") == 0
    assert re.search(rf"triangles\W+{len(_triangles())}\b", capsys.readouterr().out)
    with np.load(tmp_path / "out.npz") as arrays:
        assert arrays["points"].shape == POINTS.shape
        np.testing.assert_array_equal(canonical(arrays["triangles"]), _triangles())
    assert _main("verify", tmp_path / "out.npz") == 0
    assert "a Delaunay triangulation" in capsys.readouterr().out


def test_dimension_2_takes_x_and_y_of_three_columns(tmp_path):
    rows = np.column_stack([POINTS, np.arange(len(POINTS))])
    source = _csv(tmp_path / "points.csv", rows, "x,y,z")
    out = tmp_path / "out.vtu"
    assert _main("triangulate", source, "-o", out, "--dimension", 2, "--method", "batch", "--threads", 3) == 0
    mesh = read_plane_mesh(out)
    np.testing.assert_array_equal(mesh.points, POINTS)
    np.testing.assert_array_equal(canonical(mesh.triangles), _triangles())
    # and in space without it
    assert _main("triangulate", source, "-o", tmp_path / "space.npz") == 0
    with np.load(tmp_path / "space.npz") as arrays:
        assert arrays["simplices"].shape[1] == 4


@pytest.mark.parametrize("extension", WRITERS)
def test_every_format_holds_the_triangles(tmp_path, extension):
    out = tmp_path / f"out{extension}"
    source = tmp_path / "points.npy"
    np.save(source, POINTS)
    assert _main("triangulate", source, "-o", out) == 0
    if (mesh := read_plane_mesh(out)) is not None:
        np.testing.assert_array_equal(mesh.points, POINTS)
        np.testing.assert_array_equal(canonical(mesh.triangles), _triangles())
        assert _main("verify", out) == 0
    else:
        assert extension in (".vtp", ".ply", ".stl", ".obj")
        found = read_points(out)  # with z = 0
        assert not found[:, 2].any()
        want = POINTS.astype(np.float32) if extension == ".stl" else POINTS
        np.testing.assert_array_equal(np.unique(found[:, :2], axis=0), np.unique(want, axis=0))
    if extension in (".vtp", ".ply", ".stl", ".obj"):
        import pyvista

        surface = pyvista.read(out)
        assert surface.n_cells == len(_triangles())
        assert surface.area == pytest.approx(_area(), rel=1e-6)


def _area():
    a, b, c = POINTS[_triangles()].swapaxes(0, 1)
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2


def test_a_picture_of_the_plane(tmp_path):
    source = _csv(tmp_path / "points.csv", POINTS)
    picture = tmp_path / "plane.png"
    assert _main("triangulate", source, "-o", tmp_path / "out.vtk", "--picture", picture) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("points", "words", "message"),
    [
        (2, ["--method", "extrapolation"], "--method extrapolation goes with points in space"),
        (2, ["--method", "insertion"], "has two coordinates per point.*--method insertion"),
        (2, ["--machine", "device"], "--machine device goes with points in space"),
        (2, ["--robustness", "perturb"], "--robustness perturb goes with points in space"),
        (2, ["--dtype", "float32"], "--dtype float32 goes with points in space"),
        (2, ["--dimension", "3"], r"expected an array of shape \(n, 3\), found \(42, 2\)"),
        (3, ["--dimension", "2", "--machine", "device"], "--dimension 2 asks.*--machine device"),
        (3, ["--method", "batch"], "--method batch goes with points in the plane.*say --dimension 2"),
        (2, ["--method", "batch", "--threads", "1"], "needs a searching and a specialised thread"),
        (2, ["--threads", "0"], "threads must be an integer of at least 1"),
    ],
)
def test_options_that_do_not_go_together_are_one_line(tmp_path, capsys, points, words, message):
    rows = POINTS if points == 2 else np.column_stack([POINTS, POINTS[:, 0] ** 2])
    source = _csv(tmp_path / "points.csv", rows)
    assert _main("triangulate", source, "-o", tmp_path / "out.vtu", *words) == 2
    error = capsys.readouterr().err
    assert re.search(message, error), error
    assert error.count("\n") == 1
    assert not (tmp_path / "out.vtu").exists()


def test_the_advice_for_a_method_of_the_plane(tmp_path):
    source = _csv(tmp_path / "points.csv", np.column_stack([POINTS, POINTS[:, 0] ** 2]))
    words = ["triangulate", source, "-o", tmp_path / "out.obj", "--method", "batch", "--dimension", "2"]
    assert _main(*words) == 0


@pytest.mark.parametrize("extension", [".obj", ".vtp"])
def test_formats_of_the_plane_do_not_hold_tetrahedra(tmp_path, capsys, extension):
    source = _csv(tmp_path / "points.csv", np.column_stack([POINTS, POINTS[:, 0] ** 2]))
    assert _main("triangulate", source, "-o", tmp_path / f"out{extension}") == 2
    assert "cannot write a mesh to" in capsys.readouterr().err


def test_an_unknown_extension_is_refused_before_reading(tmp_path, capsys):
    assert _main("triangulate", tmp_path / "none.csv", "-o", tmp_path / "out.txt", "--dimension", "2") == 2
    assert "cannot write triangles to" in capsys.readouterr().err


def test_verify_refuses_what_is_no_delaunay_triangulation(tmp_path, capsys):
    square = np.array([[0.0, 0], [4, 0], [4, 1], [0, 2]])
    tri = threaded2d.Delaunay(square)
    wrong = {(0, 1, 3): [[0, 1, 2], [0, 2, 3]], (0, 1, 2): [[0, 1, 3], [1, 2, 3]]}
    np.savez(tmp_path / "flipped.npz", points=square, triangles=wrong[tuple(canonical(tri.triangles)[0])])
    assert _main("verify", tmp_path / "flipped.npz") == 1
    assert "NOT a Delaunay triangulation" in capsys.readouterr().out
    np.savez(tmp_path / "beyond.npz", points=square, triangles=[[0, 1, 9]])
    assert _main("verify", tmp_path / "beyond.npz") == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_triangles_in_space_are_no_triangulation_in_the_plane(tmp_path, capsys):
    import meshio

    points = np.column_stack([POINTS, POINTS[:, 0]])
    meshio.Mesh(points, {"triangle": _triangles()}).write(tmp_path / "surface.vtu")
    assert read_plane_mesh(tmp_path / "surface.vtu") is None
    assert _main("verify", tmp_path / "surface.vtu") == 2
    assert "holds no tetrahedra" in capsys.readouterr().err


def test_coordinates_of_all_magnitudes_survive_obj(tmp_path):
    points = np.array([[1e300, -0.1], [5e-324, 1 / 3], [-1e-300, 7.0], [2.0**53, 1.0]])
    write_plane_mesh(threaded2d.Delaunay(points), tmp_path / "out.obj")
    np.testing.assert_array_equal(read_points(tmp_path / "out.obj", dimension=2), points)


@pytest.mark.parametrize("columns", [[0, 1], [1, 2], [0, 2]])
def test_the_advice_for_sites_on_a_plane_of_space(columns):
    flat = np.full((len(POINTS), 3), 7.0)
    flat[:, columns] = POINTS
    advice = re.escape("in the plane pass two coordinates, points[:, :2], or other two columns")
    with pytest.raises(dt3d.DegenerateInputError, match=advice) as caught:
        dt3d.Delaunay(flat)
    assert caught.value.dimension == 2
    taken = flat[:, :2] if columns == [0, 1] else flat[:, columns]
    np.testing.assert_array_equal(canonical(threaded2d.Delaunay(taken).triangles), _triangles())


def test_no_such_advice_for_sites_on_a_line():
    with pytest.raises(dt3d.DegenerateInputError) as caught:
        dt3d.Delaunay(np.outer(np.arange(9), [1.0, 2, 3]))
    assert "two coordinates" not in str(caught.value)

"""Damaged files of every format: the right points, or one line that names the file; nothing printed."""

from itertools import islice
from zlib import crc32

import numpy as np
import pytest

from dt3d.files import read_mesh, read_points

from .good_files import FILES, MESHES, POINTS, TETRAHEDRA, corruptions, gzipped, whole


def spoiled(tmp_path, name, number):
    """Files to be read, each with the kind of its corruption."""
    good = whole(tmp_path, name)
    for k, (kind, data) in enumerate(islice(corruptions(good.read_bytes(), crc32(name.encode())), number)):
        path = tmp_path / f"spoiled {k} by {kind}{good.suffix}"
        path.write_bytes(data)
        yield kind, path


def complaint(error, path):
    """The message of an error, if it is one printable line that names the file."""
    message = str(error)
    assert message.isprintable(), message
    assert str(path) in message
    assert len(message) < 800
    return message


def check_points(tmp_path, name, number):
    refused = 0
    for kind, path in spoiled(tmp_path, name, number):
        try:
            points = read_points(path)
        except (ValueError, OSError) as error:
            complaint(error, path)
            refused += 1
            continue
        assert kind not in ("empty", "zeros", "garbage"), path
        assert points.dtype == np.float64
        if name.startswith("stl"):
            continue  # each corner is there once, and a changed one is another
        assert points.shape == POINTS.shape, path
        if kind == "cut":
            # of text, the last number may have lost digits
            differ = (points != POINTS).any(axis=1)
            assert not differ[:-1].any(), path
            assert not differ[-1] or "text" in name, path
    assert refused >= 3


def check_mesh(tmp_path, name, number):
    for kind, path in spoiled(tmp_path, name, number):
        try:
            mesh = read_mesh(path)
        except (ValueError, OSError) as error:
            complaint(error, path)
            continue
        assert kind not in ("empty", "zeros", "garbage"), path
        assert mesh.points.shape == POINTS.shape
        assert mesh.simplices.shape[1] == 4
        assert 0 <= mesh.simplices.min() <= mesh.simplices.max() < len(POINTS)
        assert mesh.iteration.shape == (len(mesh.simplices),)
        if kind == "cut":
            np.testing.assert_array_equal(mesh.simplices, TETRAHEDRA)
            np.testing.assert_array_equal(mesh.points, POINTS)


@pytest.mark.parametrize("name", FILES)
def test_a_whole_file_has_all_points(tmp_path, name):
    path = whole(tmp_path, name)
    np.testing.assert_array_equal(read_points(path), POINTS)
    np.testing.assert_array_equal(read_points(gzipped(path)), POINTS)


@pytest.mark.parametrize("name", MESHES)
def test_a_whole_file_has_all_tetrahedra(tmp_path, name):
    path = whole(tmp_path, name)
    mesh = read_mesh(path)
    np.testing.assert_array_equal(mesh.points, POINTS)
    np.testing.assert_array_equal(mesh.simplices, TETRAHEDRA)
    np.testing.assert_array_equal(read_mesh(gzipped(path)).simplices, TETRAHEDRA)


@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_is_one_line_or_read_right(tmp_path, name, capfd, caplog):
    check_points(tmp_path, name, 12)
    assert capfd.readouterr() == ("", "")
    assert not caplog.records  # without a handler they would be printed


@pytest.mark.parametrize("name", MESHES)
def test_a_damaged_mesh_is_one_line_or_read_right(tmp_path, name, capfd):
    check_mesh(tmp_path, name, 12)
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_forty_damaged_files_of_every_format(tmp_path, name, capfd, caplog):
    check_points(tmp_path, name, 40)
    if name in MESHES:
        check_mesh(tmp_path, name, 40)
    assert capfd.readouterr() == ("", "")
    assert not caplog.records

"""What the files of a triangulation hold."""

import numpy as np
import pytest

from dt3d.files import read_points, write_mesh


def test_hulls_of_all_magnitudes(cube, tmp_path):
    for scale in (1e-300, 1e-30, 1.0, 1e30, 1e300):
        cube.points = cube.points / cube.points.max() * scale
        write_mesh(cube, tmp_path / "a.ply")
        assert {tuple(row) for row in read_points(tmp_path / "a.ply")} == {tuple(row) for row in cube.points}
        if scale < 1e38:
            write_mesh(cube, tmp_path / "a.stl")
    with pytest.raises(ValueError, match=r"1e\+300 is beyond the single precision of \.stl; write \.ply"):
        write_mesh(cube, tmp_path / "a.stl")
    write_mesh(cube, tmp_path / "a.ply")


def test_normals_of_stl_point_outwards(cube, tmp_path):
    write_mesh(cube, tmp_path / "a.stl")
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    faces = np.frombuffer((tmp_path / "a.stl").read_bytes()[84:], kind)
    assert len(faces) == 12
    outwards = np.einsum("ij,ij->i", faces["normal"], faces["corners"].mean(axis=1) - 0.5)
    np.testing.assert_allclose(outwards, 0.5)

"""What a file says of its points, read beside them."""

import gzip

import numpy as np
import pytest
import pyvista as pv

from dt3d.files import read_cloud, read_points
from dt3d.reading.point_data import PointData, join
from dt3d.reading.text_values import values_of

from .clouds import (
    DATA,
    POINTS,
    WRITERS,
    N,
    check,
    cloud,
)


@pytest.mark.parametrize("name", WRITERS)
def test_a_cloud_has_points_and_their_data(tmp_path, name):
    write, expected = WRITERS[name]
    path = tmp_path / name
    write(path)
    found = read_cloud(path)
    np.testing.assert_array_equal(found.points, POINTS)
    np.testing.assert_array_equal(read_points(path), POINTS)
    check(found.point_data, expected)
    assert found.left_out == {}
    assert all(values.flags.writeable for values in found.point_data.values())

    (tmp_path / f"{name}.gz").write_bytes(gzip.compress(path.read_bytes()))
    check(read_cloud(tmp_path / f"{name}.gz").point_data, expected)


def test_pieces_and_blocks(tmp_path):
    parts = [cloud(), cloud()]
    del parts[1].point_data["pair"]
    parts[1].point_data["class"] = parts[1]["class"].astype(float)
    blocks = pv.MultiBlock(parts)
    blocks.save(tmp_path / "both.vtm")
    found = read_cloud(tmp_path / "both.vtm")
    assert found.points.shape == (2 * N, 3)
    twice = {name: np.concatenate([DATA[name]] * 2) for name in ("temperature", "big", "velocity")}
    check(found.point_data, twice)
    assert found.left_out == {
        "class": "its type is not the same in all pieces",
        "pair": "1 of 2 pieces have it",
    }


def test_images_and_grids(tmp_path):
    image = pv.ImageData(dimensions=(3, 4, 5))
    image["value"] = np.arange(60, dtype=np.int32)
    image.save(tmp_path / "image.vti")
    image.cast_to_rectilinear_grid().save(tmp_path / "grid.vtr")
    image.cast_to_structured_grid().save(tmp_path / "grid.vts")
    image.save(tmp_path / "image.vtk")
    for name in ("image.vti", "grid.vtr", "grid.vts", "image.vtk"):
        found = read_cloud(tmp_path / name)
        check(found.point_data, {"value": np.arange(60, dtype=np.int32)})
        np.testing.assert_allclose(found.points, image.points)


def test_attributes_of_the_legacy_format(tmp_path):
    rows = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    text = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n" + rows
    text += "POINT_DATA 4\nSCALARS heat short 1\nLOOKUP_TABLE mine\n1 2 3 4\n"
    text += "LOOKUP_TABLE mine 2\n0 0 0 1 1 1 1 1\nVECTORS flow%20field float\n" + rows
    text += "COLOR_SCALARS paint 3\n" + rows + "TEXTURE_COORDINATES uv 2 double\n0 0 1 0 0 1 1 1\n"
    text += "FIELD FieldData 1\non 1 4 bit\n1 0 1 1\nSOMETHING else\n"
    (tmp_path / "cloud.vtk").write_text(text)
    found = read_cloud(tmp_path / "cloud.vtk")
    types = {name: (values.dtype.str[1:], values.shape) for name, values in found.point_data.items()}
    assert types == {
        "heat": ("i2", (4,)),
        "flow field": ("f4", (4, 3)),
        "paint": ("f4", (4, 3)),
        "uv": ("f8", (4, 2)),
        "on": ("b1", (4,)),
    }
    assert found.point_data["on"].tolist() == [True, False, True, True]
    assert found.left_out == {"SOMETHING": "what begins with this word is not understood"}


def test_elements_of_molecules(tmp_path):
    source = tmp_path / "molecule.xyz"
    source.write_text(
        f"{N}\ncomment\n" + "".join(f"C{k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(POINTS.tolist()))
    )
    assert read_cloud(source).point_data["element"].tolist() == [f"C{k}" for k in range(N)]


def test_lists_of_vertices_and_objects(tmp_path):
    head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    (tmp_path / "lists.ply").write_text(
        head + "property list uchar int near\nend_header\n0 0 0 1 1\n1 1 1 0\n"
    )
    assert read_cloud(tmp_path / "lists.ply").left_out == {"near": "it is a list"}
    np.savez(tmp_path / "a.npz", points=POINTS, things=np.array([{}] * N))
    assert read_cloud(tmp_path / "a.npz").left_out == {"things": "it holds Python objects"}


def test_an_index_of_pandas_is_no_data(tmp_path):
    (tmp_path / "a.csv").write_text(",x,y,z,t\n0,0,0,0,5\n1,1,0,0,6\n2,0,1,0,7\n")
    found = read_cloud(tmp_path / "a.csv")
    assert (list(found.point_data), found.left_out) == (["t"], {})
    (tmp_path / "b.csv").write_text(",x,y,z,t\n9,0,0,0,5\n1,1,0,0,6\n2,0,1,0,7\n")
    assert read_cloud(tmp_path / "b.csv").left_out == {"column 1": "it has no name"}


def test_heights_are_data_in_the_plane_unless_they_are_all_equal(tmp_path):
    np.save(tmp_path / "a.npy", POINTS)
    found = read_cloud(tmp_path / "a.npy", dimension=2)
    np.testing.assert_array_equal(found.point_data["z"], POINTS[:, 2])
    np.save(tmp_path / "b.npy", POINTS * [1, 1, 0])
    assert read_cloud(tmp_path / "b.npy", dimension=2).point_data == {}


@pytest.mark.parametrize(
    ("cells", "kind"),
    [
        (["1", "-2", "+3"], "int64"),
        (["1", "18446744073709551615"], "uint64"),
        (["1", "1.5", "nan", "-inf"], "float64"),
        (["1", "", "NA"], "float64"),
        (["1.0D+00", "2"], "float64"),
        (["1_000", "2"], "U"),
        (["\u0661", "2"], "U"),
        (["1", "C"], "U"),
        (["9007199254740993", "0.5"], "U"),  # float64 does not hold it
    ],
)
def test_what_cells_are(cells, kind):
    found = values_of(cells)
    assert str(found.dtype) == kind or found.dtype.kind == kind


def test_decimal_commas():
    np.testing.assert_array_equal(values_of(["0,5", "1"], ","), [0.5, 1])


def test_names_are_kept_apart_and_printable():
    keep = PointData()
    for name in ("a", "a", "b\x01", ""):
        keep.add(name, np.zeros(2))
    assert list(keep.arrays) == ["a", "a_2", "b", "unnamed"]
    with pytest.raises(ValueError, match=r"cloud: point data 'a' have shape \(2,\), and there are 3 points"):
        keep.check("cloud", 3)
    join(None, [keep])
    keep.add("mixed", np.zeros(2, [("p", int)]))
    assert "mixed" in keep.left_out


def gmsh(rows, tags=(4, 2, 9, 1)):
    """A file with four nodes and one view of them, in text."""
    nodes = "".join(f"{tag} {k % 2} {k // 2} {k == 3:d}\n" for k, tag in enumerate(tags))
    head = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{nodes}$EndNodes\n$Elements\n0\n$EndElements\n"
    view = f'$NodeData\n1\n"warm air"\n1\n0.0\n3\n0\n1\n{len(rows)}\n'
    return head + view + "".join(f"{tag} {value}\n" for tag, value in rows) + "$EndNodeData\n"


def test_views_of_gmsh_go_by_the_tags_of_nodes(tmp_path):
    path = tmp_path / "a.msh"
    path.write_text(gmsh([(1, 10.5), (2, 20), (4, 40), (9, 90)]))
    assert read_cloud(path).point_data["warm air"].tolist() == [40, 20, 90, 10.5]
    path.write_text(gmsh([(1, 10.5), (2, 20)]))
    found = read_cloud(path)
    assert (dict(found.point_data), found.left_out) == ({}, {"warm air": "2 of 4 nodes have it"})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            gmsh([(1, 1), (2, 2), (4, 4), (4, 9)]),
            "data 'warm air' name a node twice, or one that is not there",
        ),
        (
            gmsh([(1, 1), (2, 2), (4, 4), (5, 9)]),
            "data 'warm air' name a node twice, or one that is not there",
        ),
        (gmsh([(1, 1)]).replace("$EndNodeData", "7"), "expected \\$EndNodeData after 'warm air', found '7'"),
        (gmsh([(1, 1)]).replace("\n1\n1\n1 1", "\n0\n1\n1 1"), "have the integer tags \\[0, 0, 1\\]"),
        (
            gmsh([(1, 1)]).replace("\n0.0\n3\n", "\n0.0\nx\n"),
            "expected the number of integer tags, found 'x'",
        ),
    ],
)
def test_broken_views_of_gmsh(tmp_path, text, message):
    path = tmp_path / "a.msh"
    path.write_text(text)
    with pytest.raises(ValueError, match=message):
        read_cloud(path)
    assert len(read_points(path)) == 4

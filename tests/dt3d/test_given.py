"""What people pass as points: read, or an error whose advice works."""

import re
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d.interpolate import Linear

RNG = np.random.default_rng(0)
POINTS = RNG.random((20, 3))
ODD = 2**53 + 1
LONG = np.longdouble
CLASSES = {3: dt3d.Delaunay, 2: threaded2d.Delaunay}


class Column:
    """A column of a table, as those of pandas: it only gives NumPy's array."""

    def __init__(self, values):
        self.values = values

    def to_numpy(self):
        return np.asarray(self.values)


class Table:
    """A table of columns of different kinds, which rounds where it makes one array of them."""

    def __init__(self, **columns):
        self.columns = list(columns)
        self.data = columns
        self.shape = (len(next(iter(columns.values()))), len(columns))

    def __getitem__(self, name):
        return Table(**{n: self.data[n] for n in name}) if isinstance(name, list) else Column(self.data[name])

    def to_numpy(self):
        return np.column_stack([np.asarray(column, float) for column in self.data.values()])

    def __array__(self, dtype=None, copy=None):
        return self.to_numpy()

    def dropna(self):
        keep = [None not in row for row in zip(*self.data.values(), strict=True)]
        return Table(**{n: np.asarray(c)[keep].tolist() for n, c in self.data.items()})


class OnAnotherDevice:
    """As a tensor on a GPU."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        msg = "can't convert cuda:0 device type tensor to numpy. Use Tensor.cpu() first.\nmore"
        raise TypeError(msg)


def records(points, names="xyz", dtype="f8"):
    made = np.zeros(len(points), [(name, dtype) for name in names])
    for name, column in zip(names, points.T, strict=False):
        made[name] = column
    return made


def rows_as_objects(points):
    made = np.empty(len(points), object)
    for i, row in enumerate(points):
        made[i] = row
    return made


READ = {
    "a list": POINTS.tolist(),
    "a tuple of arrays": tuple(POINTS),
    "a list of masked rows with nothing masked": [np.ma.array(row) for row in POINTS],
    "a masked array with nothing masked": np.ma.array(POINTS, mask=False),
    "a masked array without a mask": np.ma.array(POINTS),
    "objects": POINTS.astype(object),
    "rows as objects": rows_as_objects(POINTS),
    "rows as lists": rows_as_objects(POINTS.tolist()),
    "fractions": np.vectorize(Fraction, otypes=[object])(POINTS),
    "Fortran order": np.asfortranarray(POINTS),
    "a view with strides": np.repeat(POINTS, 2, axis=0)[::2],
    "big-endian": POINTS.astype(">f8"),
    "a mesh with a list": SimpleNamespace(points=POINTS.tolist()),
    "a mesh": SimpleNamespace(points=POINTS),
    "a triangulation": dt3d.Delaunay(POINTS),
    "a structured array": records(POINTS),
    "a structured array with more": records(POINTS[:, ::-1], "zyxt"),
    "a structured array with capitals": records(POINTS, "XYZ"),
    "a masked structured array": np.ma.array(records(POINTS)),
    "a table": Table(a=POINTS[:, 0], b=POINTS[:, 1].tolist(), c=POINTS[:, 2].astype(object)),
}


@pytest.mark.parametrize("name", READ)
def test_what_is_read(name):
    tri = dt3d.Delaunay(READ[name])
    np.testing.assert_array_equal(tri.points, POINTS)
    assert (tri.find_simplex(READ[name]) >= 0).all()


IN_PLANE = {
    "an array": POINTS[:, :2],
    "a list": POINTS[:, :2].tolist(),
    "a structured array": records(POINTS[:, :2], "xy"),
    "a table": Table(a=POINTS[:, 0], b=POINTS[:, 1].tolist()),
    "a mesh": SimpleNamespace(points=POINTS[:, :2]),
    "a triangulation": threaded2d.Delaunay(POINTS[:, :2]),
}


@pytest.mark.parametrize("name", IN_PLANE)
def test_two_coordinates_are_read_as_points_in_the_plane(name):
    tri = dt3d.Delaunay(IN_PLANE[name])
    np.testing.assert_array_equal(tri.points, POINTS[:, :2])
    np.testing.assert_array_equal(tri.simplices, threaded2d.Delaunay(POINTS[:, :2]).simplices)


def test_other_numbers_of_coordinates_are_told_what_serves_them():
    with pytest.raises(ValueError, match=r"got \(20, 4\); .* there is scipy.spatial.Delaunay"):
        dt3d.Delaunay(np.c_[POINTS, POINTS[:, 0]])
    with pytest.raises(ValueError, match=r"got \(20, 1\); sites on a line .* np.sort"):
        dt3d.Delaunay(POINTS[:, :1])


SPARSE = np.ma.array(POINTS, mask=np.arange(60).reshape(20, 3) % 13 == 0)
WITH_NONE = np.where(np.arange(60).reshape(20, 3) == 40, None, POINTS)
WITH_NAN = np.where(np.arange(60).reshape(20, 3) == 40, np.nan, POINTS)

ERRORS = {
    "masked": (3, SPARSE, "points are a masked array, and 5 rows are masked in places"),
    "masked rows": (3, list(SPARSE), "masked array, and 5 rows are masked"),
    "masked records": (
        3,
        np.ma.array(records(POINTS), mask=[(i == 4, 0, i == 9) for i in range(20)]),
        "and 2 rows are masked",
    ),
    "transposed": (3, POINTS.T, r"shape \(n, 2\) or \(n, 3\), got \(3, 20\); it looks transposed"),
    "transposed list": (3, POINTS.T.tolist(), "looks transposed"),
    "transposed in the plane": (2, POINTS[:, :2].T, r"shape \(n, 2\), got \(2, 20\); it looks transposed"),
    "flat": (3, POINTS.ravel(), r"shape \(n, 2\) or \(n, 3\), got \(60,\)"),
    "flat, of space": (3, POINTS[:15].ravel(), r"got \(45,\); pass points.reshape\(-1, 3\)$"),
    "a batch": (3, POINTS.reshape(4, 5, 3), r"shape \(n, 2\) or \(n, 3\), got \(4, 5, 3\)"),
    "four columns": (3, np.c_[POINTS, POINTS], r"got \(20, 6\); if the first columns are the coordinates"),
    "three columns in the plane": (2, POINTS, r"got \(20, 3\); for points in space use dt3d.Delaunay"),
    "a mesh in the plane": (2, SimpleNamespace(points=POINTS), "for points in space use dt3d.Delaunay"),
    "records in the plane": (2, records(POINTS), "for points in space use dt3d.Delaunay"),
    "records of other names": (3, records(POINTS, "abc"), "structured array .* with the fields a, b, c"),
    "a mapping": (3, dict(zip("abc", POINTS.T, strict=True)), "must be an array, got a dict"),
    "NaN": (3, WITH_NAN, "1 rows have NaN or infinity, the first is row 13"),
    "NaN in a list": (3, WITH_NAN.tolist(), "1 rows have NaN or infinity, the first is row 13"),
    "NaN in objects": (3, WITH_NAN.astype(object), "1 rows have NaN or infinity, the first is row 13"),
    "NaN in a table": (
        3,
        Table(**dict(zip("abc", WITH_NAN.T, strict=True))),
        "1 rows have NaN or infinity, the first is row 13",
    ),
    "NaN in records": (3, records(WITH_NAN), "1 rows have NaN or infinity, the first is row 13"),
    "None": (3, WITH_NONE, "row 13, column 1 is None, of type NoneType"),
    "None in a list": (3, WITH_NONE.tolist(), "row 13, column 1 is None, of type NoneType"),
    "None in a table": (
        3,
        Table(**{n: c.tolist() for n, c in zip("abc", WITH_NONE.T, strict=True)}),
        r"row 13 of points\['b'\] has no value",
    ),
    "complex": (3, POINTS + 0j, "must be real numbers, got dtype complex128"),
    "text": (3, POINTS.astype(str), "must be real numbers, got dtype <U"),
    "text in a list": (3, POINTS.astype(str).tolist(), "must be real numbers, got dtype <U"),
    "bytes": (3, POINTS.astype("S32"), r"must be real numbers, got dtype \|S32"),
    "bool": (3, np.indices((2, 2, 2)).reshape(3, -1).T > 0, "must be real numbers, got dtype bool"),
    "times": (3, (POINTS * 10**6).astype("M8[s]"), r"must be real numbers, got dtype datetime64\[s\]"),
    "durations": (3, (POINTS * 10**6).astype("m8[s]"), r"must be real numbers, got dtype timedelta64\[s\]"),
    "a generator": (3, (row for row in POINTS), "must be an array of numbers, got a generator; pass list"),
    "integers": (3, (POINTS * 2**60).astype(int) | 1, "row 0, column 0 of points is .*does not hold exactly"),
    "integers in a table": (
        3,
        Table(a=[ODD, 1, 2, 3], b=[0.5, 1, 4, 9], c=[0, 1, 8, 27]),
        rf"row 0 of points\['a'\] is {ODD}, which float64 does not hold exactly",
    ),
    "integers in records": (
        3,
        records((POINTS * 2**60).astype(int) | 1, dtype=int),
        r"row 0 of points\['x'\] is .*, which float64 does not hold exactly",
    ),
    "more columns in a table": (
        3,
        Table(label=["a"] * 20, Z=POINTS[:, 2], X=POINTS[:, 0], Y=POINTS[:, 1]),
        "must have 2 or 3 columns, got 4: label, Z, X, Y",
    ),
    "a plane in space": (3, POINTS * [1, 1, 0], r"lie on a plane .* in the plane pass two coordinates"),
}


@pytest.mark.parametrize("name", ERRORS)
def test_the_advice_of_an_error_works(name):
    dimension, points, message = ERRORS[name]
    if name == "a generator":
        points = (row for row in POINTS)
    with pytest.raises(ValueError, match=message) as caught:
        CLASSES[dimension](points)
    text = str(caught.value).replace("pass two coordinates, ", "pass ")
    assert "\n" not in text
    pieces = re.findall(r"\bpass (.+?)(?:, or|\. For|$)", text)
    other = re.findall(r"(?:use|is) (dt3d[\w.]*Delaunay)", text)
    assert pieces or other
    for expression in pieces:
        points = (row for row in POINTS) if name == "a generator" else points
        advised = eval(expression, {"points": points, "np": np})
        assert CLASSES[dimension](advised).verify()
    if other:
        if dimension == 3:
            points = np.asarray(points)[:, :2]
        assert eval(other[0])(points).verify()


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([[1, 2, 3], [4, 5], [6, 7, 8]], "do not have one length: row 1 has 2 numbers, row 0 has 3"),
        (rows_as_objects([[1, 2, 3], [4, 5]]), "do not have one length: row 1 has 2 numbers"),
        ([[1, 2, [3]], [4, 5, 6]], "do not have one length"),
        (
            OnAnotherDevice(POINTS),
            "OnAnotherDevice cannot be made a NumPy array: can't convert cuda:0 .*first.$",
        ),
        (None, "must be an array of numbers, got a NoneType"),
        (object(), "must be an array of numbers, got a object"),
        (3, r"shape \(n, 2\) or \(n, 3\), got \(\)"),
        ([], "got|empty"),
        ([[]], r"shape \(n, 2\) or \(n, 3\), got \(1, 0\)"),
        (set(), "got a set; pass list"),
        (
            [[LONG("1e4000"), 1, 2]] * 4,
            "row 0, column 0 of .* too great for float64 .*; divide all by a power of two",
        )
        if np.finfo(LONG).max > 1e308
        else ([[10**400, 1, 2]] * 4, "too great"),
    ],
)
def test_what_is_named_without_an_expression(points, message):
    with pytest.raises(ValueError, match=message) as caught:
        dt3d.Delaunay(points)
    assert "\n" not in str(caught.value)


def test_numbers_too_great_for_float64_are_divided_as_advised():
    given = (POINTS * 2**20).astype(int).astype(object) * 2**2000
    with pytest.raises(ValueError, match="too great for float64 .*; divide all by a power of two"):
        dt3d.Delaunay(given)
    assert dt3d.Delaunay(given // 2**2000).verify()


@pytest.mark.parametrize("path", ["points.csv", Path("points.csv")])
def test_the_name_of_a_file_is_no_set_of_points(path, tmp_path):
    np.savetxt(tmp_path / "points.csv", POINTS, delimiter=",")
    with pytest.raises(ValueError, match=r"for a file pass dt3d.files.read_points\(path\)"):
        dt3d.Delaunay(path)
    from dt3d.files import read_points

    assert dt3d.Delaunay(read_points(tmp_path / path)).verify()


QUERIES = {
    "masked": (SPARSE, "xi are a masked array, and 5 rows are masked"),
    "transposed": (POINTS.T, r"must have shape \(\.\.\., 3\), got \(3, 20\); it looks transposed"),
    "text": (POINTS.astype(str), "xi must be real numbers, got dtype <U"),
    "None": (WITH_NONE, "xi must be real numbers; row 13, column 1 is None"),
    "complex": (POINTS + 0j, "xi must be real numbers, got dtype complex128"),
    "integers": ((POINTS * 2**60).astype(int) | 1, "row 0, column 0 of xi is .*does not hold exactly"),
    "bool": (POINTS > 0.5, "xi must be real numbers, got dtype bool"),
}


@pytest.mark.parametrize("name", QUERIES)
def test_errors_of_points_to_be_located_are_about_these_and_their_advice_works(name):
    xi, message = QUERIES[name]
    tri = dt3d.Delaunay(POINTS)
    with pytest.raises(ValueError, match=message) as caught:
        tri.find_simplex(xi)
    assert "points must" not in str(caught.value)
    for expression in re.findall(r"\bpass (.+?)$", str(caught.value)):
        assert tri.find_simplex(eval(expression, {"xi": xi, "np": np})).dtype == np.int32


def test_ragged_points_to_be_located():
    with pytest.raises(
        ValueError, match=r"^xi must .*do not have one length: row 1 has 2 numbers, row 0 has 3"
    ):
        dt3d.Delaunay(POINTS).find_simplex([[1, 2, 3], [4, 5]])


def test_masked_queries_with_nothing_masked_are_located():
    tri = dt3d.Delaunay(POINTS)
    assert (tri.find_simplex(np.ma.array(POINTS, mask=False)) >= 0).all()


def test_tables_of_pandas():
    import pandas

    frame = pandas.DataFrame(POINTS, columns=["x", "y", "z"])
    for given in (frame, frame.astype("Float64"), frame.astype(object)):
        np.testing.assert_array_equal(dt3d.Delaunay(given).points, POINTS)
    integers = pandas.DataFrame((POINTS * 100).astype(int)).astype("Int64")
    np.testing.assert_array_equal(dt3d.Delaunay(integers).points, (POINTS * 100).astype(int))
    for points in (frame.copy(), frame.astype("Float64"), integers):
        points.iloc[7, 1] = np.nan if points.dtypes.iloc[1].kind == "f" else pandas.NA
        with pytest.raises(ValueError, match=r"row 7 of points\[.*\] has no value, .*pass points.dropna\(\)"):
            dt3d.Delaunay(points)
        assert len(dt3d.Delaunay(points.dropna()).points) == 19
    frame.iloc[3, 2] = np.inf
    for points in (frame, frame.astype("Float64")):
        with pytest.raises(ValueError, match="NaN or infinity, the first is row 3; .*pass ") as caught:
            dt3d.Delaunay(points)
        advised = eval(re.findall("pass (.+)$", str(caught.value))[0], {"points": points, "np": np})
        assert len(dt3d.Delaunay(advised).points) == 19
    labelled = frame.assign(label="a")
    with pytest.raises(ValueError, match=r"got 4: x, y, z, label; pass points\[\['x', 'y', 'z'\]\]"):
        dt3d.Delaunay(labelled)
    mixed = pandas.DataFrame({"x": [ODD, 0, 1, 2], "y": [0.5, 1, 2, 4], "z": [1, 0, 0, 5]})
    with pytest.raises(ValueError, match=rf"row 0 of points\['x'\] is {ODD}"):
        dt3d.Delaunay(mixed)


def test_a_mesh_of_pyvista():
    import pyvista

    mesh = pyvista.PolyData(POINTS.astype(np.float32))
    np.testing.assert_array_equal(dt3d.Delaunay(mesh).points, POINTS.astype(np.float32))
    with pytest.raises(ValueError, match=r"without the third coordinate pass points.points\[:, :2\]"):
        threaded2d.Delaunay(mesh)


def test_datasets_of_pyvista():
    import pyvista

    axis = np.array([0.0, 1, 3])
    cloud = pyvista.PolyData(POINTS)
    datasets = [
        cloud.cast_to_unstructured_grid(),
        cloud.cast_to_pointset(),
        pyvista.ImageData(dimensions=(3, 3, 3)),
        pyvista.RectilinearGrid(axis, axis, axis),
        pyvista.StructuredGrid(*np.meshgrid(axis, axis, axis)),
    ]
    for dataset in datasets:
        np.testing.assert_array_equal(dt3d.Delaunay(dataset).points, dataset.points)
        np.testing.assert_array_equal(dt3d.Voronoi(dataset).points, dataset.points)
    values = np.arange(len(POINTS))
    np.testing.assert_allclose(Linear(cloud, values)(cloud), values, atol=1e-9)


def test_a_mesh_of_meshio():
    import meshio

    mesh = meshio.Mesh(POINTS, [("vertex", [[0]])])
    np.testing.assert_array_equal(dt3d.Delaunay(mesh).points, POINTS)


def test_what_vtk_has_beside_datasets():
    import pyvista
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    blocks = pyvista.MultiBlock([pyvista.PolyData(POINTS), None])
    with pytest.raises(ValueError, match=r"got a MultiBlock of 2 datasets; pass points\.combine\(\)"):
        dt3d.Delaunay(blocks)
    assert len(dt3d.Delaunay(blocks.combine()).points) == len(POINTS)
    plain = vtkPolyData()
    plain.ShallowCopy(pyvista.PolyData(POINTS))
    with pytest.raises(ValueError, match=r"got a vtkPolyData; pass pyvista\.wrap\(points\)"):
        dt3d.Delaunay(plain)
    assert len(dt3d.Delaunay(pyvista.wrap(plain)).points) == len(POINTS)


def test_arrays_of_jax():
    import jax.numpy as jnp

    tri = dt3d.Delaunay(jnp.asarray(POINTS, jnp.float32))
    np.testing.assert_array_equal(tri.points, POINTS.astype(np.float32))
    points = jnp.asarray(POINTS, jnp.bfloat16)
    with pytest.raises(ValueError, match="real numbers, got dtype bfloat16; .*pass ") as caught:
        dt3d.Delaunay(points)
    advised = eval(re.findall("pass (.+)$", str(caught.value))[0], {"points": points, "np": np})
    assert dt3d.Delaunay(advised).verify()


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
@pytest.mark.parametrize(
    "given",
    [
        np.column_stack([POINTS[:, :2], np.zeros(20)]),
        SimpleNamespace(points=np.column_stack([POINTS[:, :2], np.zeros(20)])),
        np.column_stack([POINTS[:, :2], np.zeros(20)]).tolist(),
    ],
    ids=["array", "dataset", "list"],
)
def test_the_advice_for_points_on_a_plane_works(given, method):
    with pytest.raises(dt3d.DegenerateInputError, match="lie on a plane") as caught:
        dt3d.Delaunay(given, method=method)
    assert caught.value.dimension == 2
    advice = re.search(r"pass two coordinates, (.*?), or other two", str(caught.value))[1]
    assert dt3d.Delaunay(eval(advice, {"points": given, "np": np})).ndim == 2

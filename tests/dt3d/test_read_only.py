"""Results stay as they were computed, and compiled code reads nothing that was not checked."""

import copy
import pickle
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d.location import Locator

POINTS = np.random.default_rng(0).random((60, 3))
KINDS = ["space", "plane"]
ARRAYS = {
    "space": ["points", "simplices", "neighbors", "iteration", "duplicates", "convex_hull"],
    "plane": [
        "points",
        "triangles",
        "simplices",
        "neighbors",
        "thread",
        "inserted_by",
        "duplicates",
        "convex_hull",
    ],
}


def triangulation(kind):
    return dt3d.Delaunay(POINTS) if kind == "space" else threaded2d.Delaunay(POINTS[:, :2])


def arrays_of(kind, tri):
    more = zip(["indptr", "indices"], tri.vertex_neighbor_vertices, strict=True)
    return {name: getattr(tri, name) for name in ARRAYS[kind]} | dict(more)


@pytest.mark.parametrize("kind", KINDS)
def test_arrays_are_read_only_for_good(kind):
    tri = triangulation(kind)
    for array in arrays_of(kind, tri).values():
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[:] += 1
        with pytest.raises(ValueError, match="read-only"):
            array.sort(axis=0)
        for view in (array, array.view(), array[:1], array.T):
            with pytest.raises(ValueError, match="cannot set WRITEABLE flag"):
                view.flags.writeable = True
    assert tri.verify()


@pytest.mark.parametrize("kind", KINDS)
def test_attributes_are_neither_assigned_nor_deleted_and_the_error_says_what_to_do(kind):
    tri = triangulation(kind)
    for name in [*ARRAYS[kind], "stats"]:
        for change in (lambda name: setattr(tri, name, getattr(tri, name)), lambda name: delattr(tri, name)):
            with pytest.raises(
                AttributeError, match=f"{name} cannot be (assigned|deleted): results stay"
            ) as caught:
                change(name)
            if name != "stats":
                assert f"tri.{name}.copy() is an array to change" in str(caught.value)
                changed = getattr(tri, name).copy()
                changed[:1] = 0
            if "tri.subset(keep)" in str(caught.value):
                assert len(tri.subset([0, 2]).simplices) == 2
    with pytest.raises(AttributeError, match=r"make a new triangulation, as of points\[keep\]"):
        tri.points = POINTS
    keep = np.arange(len(tri.points)) != 3
    assert len(type(tri)(tri.points[keep]).points) == len(keep) - 1
    tri.name = "an attribute of one's own"
    del tri.name


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_points_that_change_after_the_call_change_no_result(kind, dtype):
    given = np.array(POINTS if kind == "space" else POINTS[:, :2], dtype, order="C")
    wanted = given.astype(float)
    tri = type(triangulation(kind))(given)
    given[:] = np.nan
    np.testing.assert_array_equal(tri.points, wanted)
    assert (tri.find_simplex(wanted) >= 0).all()
    assert tri.verify()


@pytest.mark.parametrize("located", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_pickles_and_copies(kind, located):
    tri = triangulation(kind)
    middle = tri.points.mean(axis=0)
    found = tri.find_simplex(middle) if located else None
    again = [pickle.loads(pickle.dumps(tri, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    for other in [*again, copy.copy(tri), copy.deepcopy(tri)]:
        assert type(other) is type(tri)
        for name, array in arrays_of(kind, tri).items():
            np.testing.assert_array_equal(arrays_of(kind, other)[name], array)
            with pytest.raises(ValueError, match="read-only"):
                arrays_of(kind, other)[name][:] = 0
        assert other.find_simplex(middle) == (found if located else tri.find_simplex(middle))
        assert other.stats == tri.stats
        assert other.verify()


def test_a_buffer_beside_a_pickle_that_changes_later_changes_no_result():
    tri = triangulation("space")
    buffers = []
    data = pickle.dumps(tri, 5, buffer_callback=buffers.append)
    beside = [bytearray(buffer.raw()) for buffer in buffers]
    other = pickle.loads(data, buffers=beside)
    for buffer in beside:
        buffer[:] = b"\x77" * len(buffer)
    np.testing.assert_array_equal(other.simplices, tri.simplices)
    assert other.verify()


def test_pickles_of_the_plane_that_call_simplices_triangles_are_read():
    tri = triangulation("plane")
    state = dict(tri.__getstate__())
    state["triangles"] = state.pop("simplices")
    other = type(tri).__new__(type(tri))
    other.__setstate__(state)
    np.testing.assert_array_equal(other.triangles, tri.triangles)
    assert other.triangles is other.simplices


TAMPERED = {
    "simplices beyond the sites": (
        "simplices",
        lambda a: np.where(a == 5, 10**6, a),
        "simplices go from 0 to",
    ),
    "negative simplices": ("simplices", lambda a: a - 1, "simplices go from -1"),
    "neighbors beyond the simplices": ("neighbors", lambda a: a + len(a), "neighbors go from"),
    "neighbors below outside": ("neighbors", lambda a: a - 1, "neighbors go from -2"),
    "another dtype": ("simplices", lambda a: a.astype(np.int64), "simplices are int64"),
    "another byte order": ("neighbors", lambda a: a.astype(">i4"), "neighbors are >i4"),
    "too few columns": ("simplices", lambda a: a[:, :2], "simplices are int32 of shape"),
    "fewer rows": ("neighbors", lambda a: a[:-1], "neighbors are int32 of shape"),
    "no rows": ("simplices", lambda a: a[:0], "int32 of shape"),
    "NaN": ("points", lambda a: a * np.nan, "points are not finite"),
    "float32": ("points", lambda a: a.astype(np.float32), "points are float32"),
    "other sites": ("points", lambda a: a[:-1], "go from 0 to 59|inserted_by"),
    "duplicates beyond the sites": (
        "duplicates",
        lambda a: np.array([[99, 0]], np.int32),
        "duplicates go from 0",
    ),
    "no array": ("points", lambda a: a.tolist(), "points is no array"),
    "a number": ("simplices", lambda a: a[0, 0], "simplices is no array"),
    "missing": ("points", lambda a: None, "there is no points"),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("how", TAMPERED)
def test_a_tampered_pickle_is_an_error(kind, how):
    name, change, message = TAMPERED[how]
    tri = triangulation(kind)
    state = dict(tri.__getstate__())
    assert not any(isinstance(value, Locator) for value in state.values())
    if (value := change(state[name])) is None:
        del state[name]
    else:
        state[name] = value
    with pytest.raises(ValueError, match=f"no triangulation of dt3d, or were changed: .*({message})"):
        type(tri).__new__(type(tri)).__setstate__(state)


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("simplices", lambda a: a + 50, "simplices go from"),
        ("simplices", lambda a: a - 1, "simplices go from -1"),
        ("neighbors", lambda a: a - 1, "neighbors go from -2"),
        ("neighbors", lambda a: a + len(a), "neighbors go from"),
        ("simplices", lambda a: a[:-1], "neighbors are int32 of shape"),
        ("simplices", lambda a: a.astype(float), "simplices are float64"),
        ("sites", lambda a: a / 0, "not finite"),
        ("sites", lambda a: a[:, :2], "simplices are int32 of shape"),
        ("sites", lambda a: a[:5], "simplices go from"),
    ],
)
def test_a_locator_checks_what_it_walks_in(name, change, message):
    tri = triangulation("space")
    arrays = {"sites": tri.points, "simplices": tri.simplices, "neighbors": tri.neighbors}
    with np.errstate(all="ignore"):
        arrays[name] = change(arrays[name])
    with pytest.raises(ValueError, match=message):
        Locator(**arrays)


ATTEMPTS = {
    "assign": "tri.simplices = tri.simplices[np.arange(len(tri.simplices)) % 2 == 0].copy()",
    "strided": "tri.simplices = tri.simplices[::2]",
    "sort": "tri.simplices.sort(axis=1)",
    "add": "tri.find_simplex(queries); tri.points[:] += 1",
    "flag": "tri.simplices.flags.writeable = True; tri.simplices[:] = 10**8",
    "flag of the base": "np.asarray(tri.neighbors.base).flags.writeable = True",
    "dict": "tri.__dict__['simplices'] = tri.simplices + 10**8",
    "dict, later": "tri.find_simplex(queries); tri.__dict__['neighbors'] = tri.neighbors + 10**8",
    "object": "object.__setattr__(tri, 'simplices', tri.simplices[:7])",
    "vertices": "tri.__dict__['simplices'] = tri.simplices + 10**8; tri.vertex_neighbor_vertices",
}


@pytest.fixture(scope="module")
def outcomes():
    """What each attempt comes to in one child process: an error, or right answers."""
    code = textwrap.dedent(
        f"""
        import numpy as np, dt3d
        points = np.random.default_rng(0).random((400, 3))
        queries = np.random.default_rng(1).random((2000, 3))
        wanted = dt3d.Delaunay(points).find_simplex(queries)
        for name, attempt in {ATTEMPTS!r}.items():
            tri, what = dt3d.Delaunay(points), ""
            try:
                exec(attempt)
            except (AttributeError, ValueError) as error:
                what = type(error).__name__
            try:
                what += " right" if (tri.find_simplex(queries) == wanted).all() else " WRONG"
            except ValueError as error:
                what += " refused"
            print(name, what, sep=":", flush=True)
        """
    )
    child = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False
    )
    assert child.returncode == 0, child.stderr
    return dict(line.split(":") for line in child.stdout.splitlines())


@pytest.mark.parametrize(
    ("attempt", "outcome"),
    [
        ("assign", "AttributeError right"),
        ("strided", "AttributeError right"),
        ("sort", "ValueError right"),
        ("add", "ValueError right"),
        ("flag", "ValueError right"),
        ("flag of the base", "ValueError right"),
        ("dict", " refused"),
        ("dict, later", " right"),
        ("object", " refused"),
        ("vertices", "ValueError refused"),
    ],
)
def test_changed_results_end_in_an_error_or_right_answers_but_not_in_a_crash(outcomes, attempt, outcome):
    assert outcomes[attempt] == outcome


def test_an_object_that_is_made_anew_forgets_what_was_derived():
    tri = triangulation("space")
    tri.find_simplex(POINTS)
    hull = tri.convex_hull
    tri.__init__(POINTS + 5)
    assert (tri.find_simplex(POINTS + 5) >= 0).all()
    assert len(hull) == len(tri.convex_hull)

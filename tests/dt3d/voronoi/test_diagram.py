"""`dt3d.Voronoi` as its users meet it: SciPy's names, options, errors, pickles; and larger sets."""

import copy
import inspect
import pickle

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d import threaded2d

RNG = np.random.default_rng(11)
PLANE, SPACE = RNG.random((400, 2)), RNG.random((400, 3))


def lattice(k, d):
    return np.stack(np.meshgrid(*[np.arange(float(k))] * d, indexing="ij"), -1).reshape(-1, d)


def members(cls):
    return {name for name in dir(cls) if not name.startswith("_")}


def test_all_members_of_scipys_are_there():
    theirs = scipy.spatial.Voronoi(PLANE)
    ours = dt3d.Voronoi(PLANE)
    assert members(theirs) <= members(ours)
    for name in members(theirs):
        value = getattr(theirs, name)
        if callable(value):
            continue
        assert type(getattr(ours, name)) is type(value), name
        if isinstance(value, np.ndarray):
            assert getattr(ours, name).dtype == value.dtype, name
            assert getattr(ours, name).ndim == value.ndim, name
    for name in ("ndim", "npoints", "furthest_site"):
        assert getattr(ours, name) == getattr(theirs, name)
    for name in ("min_bound", "max_bound", "points"):
        assert (getattr(ours, name) == getattr(theirs, name)).all()


def test_positions_and_names_are_scipys():
    names = list(inspect.signature(dt3d.Voronoi).parameters)
    assert names == ["points", "furthest_site", "incremental", "qhull_options", "threads"]
    vor = dt3d.Voronoi(PLANE, False, False, "Qbb Qc Qz")
    assert vor.regions == dt3d.Voronoi(points=PLANE, qhull_options=None).regions


@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
def test_the_same_as_scipys(points):
    ours, theirs = dt3d.Voronoi(points), scipy.spatial.Voronoi(points)
    scale = np.abs(theirs.vertices).max(axis=1)
    tree = scipy.spatial.cKDTree(ours.vertices)
    apart, same = tree.query(theirs.vertices)
    assert (apart <= 1e-9 * np.maximum(scale, 1)).all()
    assert sorted(same) == list(range(len(ours.vertices)))
    same = np.append(same, -1)
    for k in range(len(points)):
        region = theirs.regions[theirs.point_region[k]]
        assert set(ours.regions[ours.point_region[k]]) == set(same[region].tolist())
    theirs_of = {tuple(sorted(p)): set(same[v].tolist()) for p, v in theirs.ridge_dict.items()}
    ours_of = {tuple(sorted(p)): set(v) for p, v in ours.ridge_dict.items()}
    assert theirs_of.items() <= ours_of.items()
    # what SciPy leaves out
    more = [v for p, v in ours_of.items() if p not in theirs_of]
    assert all(len(v) == 2 and -1 in v for v in more)
    assert len(more) == 0 or ours.ndim == 3


def test_a_simple_lattice():
    """SciPy's test_simple, in any order."""
    vor = dt3d.Voronoi([(x, y) for x in range(3) for y in range(3)])
    assert sorted(vor.vertices.tolist()) == [[0.5, 0.5], [0.5, 1.5], [1.5, 0.5], [1.5, 1.5]]
    number = [vor.vertices.tolist().index(v) for v in ([0.5, 0.5], [0.5, 1.5], [1.5, 0.5], [1.5, 1.5])]
    a, b, c, d = number
    expected = {
        0: [-1, a], 1: [-1, a, b], 2: [-1, b], 3: [-1, a, c], 4: [a, b, c, d], 5: [-1, b, d],
        6: [-1, c], 7: [-1, c, d], 8: [-1, d],
    }  # fmt: skip
    assert {k: sorted(vor.regions[r]) for k, r in enumerate(vor.point_region)} == {
        k: sorted(v) for k, v in expected.items()
    }
    ridges = {tuple(sorted(p)): sorted(v) for p, v in vor.ridge_dict.items()}
    expected = {
        (0, 3): [-1, a], (0, 1): [-1, a], (1, 4): [a, b], (1, 2): [-1, b], (2, 5): [-1, b], (3, 4): [a, c],
        (3, 6): [-1, c], (4, 5): [b, d], (4, 7): [c, d], (5, 8): [-1, d], (6, 7): [-1, c], (7, 8): [-1, d],
    }  # fmt: skip
    assert ridges == {k: sorted(v) for k, v in expected.items()}


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("change", [lambda x: x, lambda x: x * 0.1, lambda x: x + 2.0**20, lambda x: x[::-1]])
def test_lattices_have_a_vertex_for_each_cube(d, change):
    k = 7
    vor = dt3d.Voronoi(change(lattice(k, d)))
    cubes = (k - 1) ** d
    if (vor.points == np.round(vor.points)).all():
        assert len(vor.vertices) == cubes
        assert len(vor.ridge_points) == d * (k - 1) * k ** (d - 1)
        assert (vor.vertices - np.floor(vor.vertices) == 0.5).all()
        assert np.isfinite(vor.volumes).sum() == (k - 2) ** d
        assert (vor.volumes[np.isfinite(vor.volumes)] == 1).all()
    else:  # not quite cubes
        assert len(vor.vertices) >= cubes
        assert np.allclose(vor.volumes[np.isfinite(vor.volumes)], 0.1**d, rtol=1e-12)


@pytest.mark.parametrize("d", [2, 3])
def test_duplicates_have_the_region_of_the_site_that_was_used(d):
    points = RNG.integers(0, 4, (300, d)).astype(float)
    vor = dt3d.Voronoi(points)
    unused, used = vor.triangulation.duplicates.T
    assert len(unused) > 200
    assert (vor.point_region[unused] == vor.point_region[used]).all()
    assert len(vor.regions) == 1 + len(points) - len(unused)
    assert sorted(set(vor.point_region.tolist())) == list(range(1, len(vor.regions)))
    assert (vor.volumes[unused] == 0).all()
    assert not np.isin(unused, vor.ridge_points).any()
    alone = dt3d.Voronoi(np.delete(points, unused, axis=0))
    assert (alone.volumes == np.delete(vor.volumes, unused)).all()


@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
def test_volumes_are_those_of_hulls_of_regions(points):
    vor = dt3d.Voronoi(points)
    bounded = np.flatnonzero(np.isfinite(vor.volumes))
    assert len(bounded) > 200
    for k in bounded:
        corners = vor.vertices[vor.regions[vor.point_region[k]]]
        assert vor.volumes[k] == pytest.approx(scipy.spatial.ConvexHull(corners).volume, rel=1e-8)
    on_hull = np.zeros(len(points), bool)
    on_hull[vor.triangulation.convex_hull] = True
    assert (np.isinf(vor.volumes) == on_hull).all()


@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
@pytest.mark.parametrize("power", [-490, -100, 100, 490])
def test_powers_of_two_change_nothing_else(points, power):
    one, other = dt3d.Voronoi(points[:50]), dt3d.Voronoi(np.ldexp(points[:50], power))
    d = one.ndim
    assert (np.ldexp(one.vertices, power) == other.vertices).all()
    assert (one.ridge_indices == other.ridge_indices).all()
    assert (one.region_indices == other.region_indices).all()
    with np.errstate(over="ignore", under="ignore"):
        assert np.allclose(np.ldexp(one.areas, power * (d - 1)), other.areas, rtol=1e-12)
        assert np.allclose(np.ldexp(one.volumes, power * d), other.volumes, rtol=1e-12)


@pytest.mark.parametrize("d", [2, 3])
def test_an_offset_moves_the_vertices(d):
    points = np.round(RNG.random((200, d)) * 2**20) / 2**20
    one, other = dt3d.Voronoi(points), dt3d.Voronoi(points + 2.0**20)
    assert (one.ridge_points == other.ridge_points).all()
    near = np.abs(one.vertices).max(axis=1) < 2
    assert np.abs(other.vertices - 2.0**20 - one.vertices)[near].max() < 2.0**-31


def test_vertices_beyond_all_numbers_are_infinite():
    points = np.array([[0, 0], [1, 1e-320], [2, 0], [1, 1e300]])
    vor = dt3d.Voronoi(points)
    assert np.isinf(vor.vertices).any()
    assert not np.isnan(vor.vertices).any()
    assert not np.isnan(vor.areas).any()


def test_a_triangulation_that_is_there():
    tri = dt3d.Delaunay(SPACE)
    vor = dt3d.Voronoi(tri)
    assert vor.triangulation is tri
    assert vor.points is tri.points
    assert np.allclose(vor.volumes, dt3d.Voronoi(SPACE).volumes, rtol=1e-9)
    plane = threaded2d.Delaunay(PLANE)
    assert np.allclose(dt3d.Voronoi(plane).volumes, dt3d.Voronoi(PLANE).volumes, rtol=1e-9)


def test_triangulations_that_have_no_diagram():
    tri = dt3d.Delaunay(SPACE)
    with pytest.raises(ValueError, match=r"of a whole triangulation, got a part: .* pass part\.whole"):
        dt3d.Voronoi(tri.subset([0]))
    perturbed = object.__new__(dt3d.Delaunay)
    perturbed.__setstate__(tri.__getstate__() | {"_exact": False})
    with pytest.raises(
        ValueError, match='needs an exact triangulation, this one was made with robustness="perturb"'
    ):
        dt3d.Voronoi(perturbed)


def test_a_triangulation_that_was_changed():
    """Walks about edges would not end, or read what is not there."""
    tri = dt3d.Delaunay(SPACE[:40])
    for name in ("neighbors", "simplices"):
        for seed in range(20):
            state = tri.__getstate__()
            changed = np.array(state[name])
            rng = np.random.default_rng(seed)
            row, other = rng.integers(0, len(changed), 2)
            changed[row, rng.integers(4)] = changed[other, rng.integers(4)]
            if (changed == state[name]).all():
                continue
            broken = object.__new__(dt3d.Delaunay)
            broken.__setstate__(state | {name: changed})
            with pytest.raises(ValueError, match="no triangulation of dt3d, or were changed"):
                dt3d.Voronoi(broken).vertices  # noqa: B018


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"furthest_site": True}, r"furthest_site=True is not served.*scipy\.spatial\.Voronoi"),
        ({"incremental": True}, "incremental=True is not served"),
        ({"qhull_options": "QJ"}, "QJ is not served"),
        ({"threads": 0}, "threads must be an integer of at least 1, or None, got 0"),
        ({"threads": 1.5}, r"threads must be an integer of at least 1, or None, got 1\.5"),
    ],
)
def test_options_that_are_not_served(options, message):
    with pytest.raises(ValueError, match=message):
        dt3d.Voronoi(PLANE, **options)


def test_bad_points():
    with pytest.raises(ValueError, match="points must"):
        dt3d.Voronoi(np.zeros((4, 4)))
    with pytest.raises(ValueError, match="points must be finite"):
        dt3d.Voronoi([[0, 0], [1, np.nan], [0, 1]])
    with pytest.raises(dt3d.DegenerateInputError):
        dt3d.Voronoi([[0, 0], [1, 1], [2, 2]])


def test_regions_without_the_empty_one():
    vor = dt3d.Voronoi(SPACE, qhull_options="Qbb Qc")
    with_empty = dt3d.Voronoi(SPACE)
    assert vor.regions == with_empty.regions[1:]
    assert (vor.point_region == with_empty.point_region - 1).all()


@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
def test_threads_change_nothing(points):
    points = np.concatenate([points, RNG.random((3000, points.shape[1]))])
    one, more = dt3d.Voronoi(points, threads=1), dt3d.Voronoi(points)
    # the same triangulation, since the order of simplices may differ
    more = dt3d.Voronoi(one.triangulation)
    for name in (
        "vertices",
        "ridge_points",
        "ridge_indptr",
        "ridge_indices",
        "region_indices",
        "areas",
        "volumes",
    ):
        assert (getattr(one, name) == getattr(more, name)).all(), name


ARRAYS = (
    "points", "vertices", "ridge_points", "ridge_indptr", "ridge_indices", "point_region", "region_indptr",
    "region_indices", "volumes", "areas", "vertex_of_simplex", "min_bound", "max_bound",
)  # fmt: skip


def test_results_stay_as_they_were_computed():
    vor = dt3d.Voronoi(SPACE)
    for name in ARRAYS:
        array = getattr(vor, name)
        assert getattr(vor, name) is array or (getattr(vor, name) == array).all()
        with pytest.raises(ValueError, match="read-only"):
            array[:1] = 0
        with pytest.raises(ValueError, match="cannot set WRITEABLE"):
            array.flags.writeable = True
    for name in (*ARRAYS, "regions", "ridge_vertices", "ridge_dict", "triangulation", "threads", "ndim"):
        with pytest.raises(AttributeError, match=f"{name} cannot be assigned: results stay"):
            setattr(vor, name, None)
        with pytest.raises(AttributeError, match=f"{name} cannot be deleted: results stay"):
            delattr(vor, name)
    vor.name = "an attribute of one's own"
    del vor.name
    with pytest.raises(RuntimeError, match="sites cannot be added"):
        vor.add_points([[1, 2, 3]])
    assert vor.close() is None


@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
def test_pickles_and_copies(points):
    vor = dt3d.Voronoi(points, qhull_options="Qc", threads=1)
    vor.label = "mine"
    before = {name: getattr(vor, name) for name in ARRAYS}
    for again in (pickle.loads(pickle.dumps(vor)), copy.deepcopy(vor), copy.copy(vor)):
        assert repr(again) == repr(vor)
        assert again.label == "mine"
        assert again.threads == 1
        assert again.regions == vor.regions
        for name, array in before.items():
            assert (getattr(again, name) == array).all(), name
            assert not getattr(again, name).flags.writeable
    # what can be computed again is in no pickle
    assert len(pickle.dumps(vor)) < len(pickle.dumps(vor.triangulation)) + 1000


def test_it_says_what_it_is():
    assert repr(dt3d.Voronoi(PLANE)) == "<dt3d.Voronoi: 400 sites in the plane>"
    assert repr(dt3d.Voronoi(SPACE)) == "<dt3d.Voronoi: 400 sites in space>"

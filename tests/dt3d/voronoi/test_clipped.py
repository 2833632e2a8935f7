"""Regions within boxes: their volumes sum to the box's, and each is what the definition says."""

import math
import pickle

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d.voronoi import Clipped

RNG = np.random.default_rng(7)


def lattice(k, d):
    return np.stack(np.meshgrid(*[np.arange(float(k))] * d, indexing="ij"), -1).reshape(-1, d)


def cluster(n, d, size):
    """Most sites within one of so small a size, in the unit cube."""
    return np.concatenate([RNG.random((20, d)), 0.3 + size * RNG.random((n, d))])


def on_sphere(n, d):
    x = RNG.normal(size=(n, d))
    return x / np.linalg.norm(x, axis=1, keepdims=True)


SETS = {
    "uniform": lambda d: RNG.random((3000, d)),
    "least": lambda d: np.concatenate([np.zeros((1, d)), np.eye(d)]),
    "lattice": lambda d: lattice(8, d),
    "noisy lattice": lambda d: lattice(7, d) + 1e-15 * RNG.normal(size=(7**d, d)),
    "cluster": lambda d: cluster(500, d, 1e-8),
    "nested": lambda d: np.concatenate([10.0**-k * RNG.random((50, d)) for k in range(12)]),
    "sphere": lambda d: on_sphere(300, d),
    "sphere and centre": lambda d: np.concatenate([on_sphere(300, d), np.zeros((1, d))]),
    "lines": lambda d: np.concatenate(
        [np.c_[np.arange(40.0), np.zeros((40, d - 1))], 5 + RNG.random((9, d))]
    ),
    "duplicates": lambda d: RNG.integers(0, 4, (400, d)),
    "offset": lambda d: RNG.random((1000, d)) + 1e6,
    "flat": lambda d: RNG.random((300, d)) * [1, 1e-5, 1][:d],
    "small": lambda d: RNG.random((100, d)) * 1e-80,
    "large": lambda d: RNG.random((100, d)) * 1e80,
}


def boxes(points):
    """The default, one around the sites, one beside them, and one that cuts through them."""
    low, high = points.min(axis=0), points.max(axis=0)
    side = high - low
    yield None
    yield [low - side, high + 2 * side]
    yield [low + 1.5 * side, high + 3 * side]
    yield [low + 0.3 * side, low + 0.31 * side]
    # its low corner is a site
    yield [points[len(points) // 2], points[len(points) // 2] + 0.1 * side]


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("name", SETS)
def test_volumes_sum_to_the_box(name, d):
    points = np.asarray(SETS[name](d), float)
    vor = dt3d.Voronoi(points)
    for box in boxes(points):
        inside = vor.clipped(box)
        whole = np.prod(inside.box[1] - inside.box[0])
        assert inside.volumes.shape == (len(points),)
        assert (inside.volumes >= 0).all()
        assert abs(math.fsum(inside.volumes) / whole - 1) < 1e-12
        assert (inside.volumes[vor.triangulation.duplicates[:, 0]] == 0).all()


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("size", [1.0, 1e-8, 1e-100])
def test_regions_that_are_bounded_have_their_own_volume(d, size):
    """Around the origin coordinates are as exact as regions are small."""
    points = np.concatenate([RNG.random((20, d)) - 0.5, size * (RNG.random((300, d)) - 0.5)])
    vor = dt3d.Voronoi(points)
    around = vor.clipped([[-1e3] * d, [1e3] * d])
    far = np.append(np.abs(vor.vertices).max(axis=1) > 1e3, True)
    held = [not far[vor.regions[r]].any() for r in vor.point_region]
    assert sum(held) > 150
    assert np.allclose(around.volumes[held], vor.volumes[held], rtol=1e-10, atol=0)
    held = np.array([not far[ends].any() for ends in vor.ridge_vertices])
    assert held.sum() > 300
    # rounding is one of the smaller region that has the ridge
    extent = [
        np.linalg.norm(vor.vertices[vor.regions[r]] - points[k], axis=1).max()
        for k, r in enumerate(vor.point_region)
    ]
    extent = np.array(extent)[vor.ridge_points].min(axis=1)
    off = np.abs(around.areas[held] - vor.areas[held])
    assert (off <= 1e-7 * extent[held] ** (d - 1)).all()
    assert np.median(off / vor.areas[held]) < 1e-12


@pytest.mark.parametrize("d", [2, 3])
def test_the_same_as_regions_between_reflections(d):
    """A wall is the bisector of each site and its mirror image."""
    points = RNG.random((60, d))
    images = [points]
    for axis in range(d):
        for wall in (0.0, 1.0):
            image = points.copy()
            image[:, axis] = 2 * wall - image[:, axis]
            images.append(image)
    theirs = scipy.spatial.Voronoi(np.concatenate(images))
    inside = dt3d.Voronoi(points).clipped([[0] * d, [1] * d])
    for k in range(len(points)):
        corners = theirs.vertices[theirs.regions[theirs.point_region[k]]]
        assert inside.volumes[k] == pytest.approx(scipy.spatial.ConvexHull(corners).volume, rel=1e-9)


def measured(cell):
    """The volume of a polytope, and the areas of its faces, from its corners."""
    if cell.vertices.shape[1] == 2:
        ends = cell.vertices[np.array(cell.faces)]
        twice = ends[:, 0, 0] * ends[:, 1, 1] - ends[:, 0, 1] * ends[:, 1, 0]
        return twice.sum() / 2, np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    volume, areas = 0.0, []
    for face in cell.faces:
        corners = cell.vertices[face]
        normal = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0]).sum(axis=0) / 2
        volume += corners[0] @ normal / 3
        areas.append(np.linalg.norm(normal))
    return volume, np.array(areas)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("name", ["uniform", "lattice", "duplicates", "sphere and centre"])
def test_polytopes(name, d):
    points = np.asarray(SETS[name](d), float)[:400]
    vor = dt3d.Voronoi(points)
    box = [points.min(axis=0) - 0.5, points.max(axis=0) - 0.25]
    inside = vor.clipped(box)
    lengths = dict(zip(map(tuple, np.sort(vor.ridge_points, axis=1).tolist()), inside.areas, strict=True))
    unused = set(vor.triangulation.duplicates[:, 0].tolist())
    used = [k for k in range(len(points)) if k not in unused]
    for k in [*used[:40], *unused][:60]:
        cell = inside.cell(k)
        assert len(cell.faces) == len(cell.neighbors)
        if k in unused:
            assert cell.vertices.shape == (0, d)
            assert cell.faces == []
            continue
        volume, areas = measured(cell) if cell.faces else (0.0, np.array([]))
        assert volume == pytest.approx(inside.volumes[k], rel=1e-9, abs=1e-13)
        # each edge is walked in both directions, or in the plane each corner left and reached
        steps = cell.faces if d == 2 else [e for f in cell.faces for e in zip(f, f[1:] + f[:1], strict=True)]
        if d == 2:
            assert (
                sorted(v for v, _ in steps) == sorted(w for _, w in steps) == list(range(len(cell.vertices)))
            )
        else:
            assert sorted(steps) == sorted((w, v) for v, w in steps)
        for area, other, face in zip(areas, cell.neighbors.tolist(), cell.faces, strict=True):
            corners = cell.vertices[face]
            if other == dt3d.OUTSIDE:
                on_wall = np.isclose(corners[:, None], inside.box, rtol=0, atol=1e-12).all(axis=0)
                assert on_wall.any()
            else:
                assert area == pytest.approx(lengths[min(k, other), max(k, other)], rel=1e-9, abs=1e-10)
                lengths_to = [np.linalg.norm(corners - points[i], axis=1) for i in (k, other)]
                assert np.allclose(*lengths_to, rtol=0, atol=1e-12)
        # no site is nearer to a corner
        for corner in cell.vertices:
            apart = np.linalg.norm(points - corner, axis=1)
            assert apart[k] <= apart.min() + 1e-12
            assert (corner >= inside.box[0] - 1e-12).all()
            assert (corner <= inside.box[1] + 1e-12).all()


def test_a_ridge_outside_of_the_box_has_no_area():
    vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
    inside = vor.clipped([[0, 0], [0.5, 0.25]])
    assert inside.volumes.tolist() == [0.125, 0, 0, 0, 0]
    assert (inside.areas == 0).all()
    empty = inside.cell(4)
    assert (empty.vertices.shape, empty.faces, empty.neighbors.shape) == ((0, 2), [], (0,))


@pytest.mark.parametrize("d", [2, 3])
def test_powers_of_two_change_nothing_else(d):
    points = RNG.random((50, d))
    one = dt3d.Voronoi(points).clipped()
    for power in (-60, 60):
        other = dt3d.Voronoi(np.ldexp(points, power)).clipped()
        assert (np.ldexp(other.volumes, -power * d) == one.volumes).all()
        assert (np.ldexp(other.areas, -power * (d - 1)) == one.areas).all()
        assert (np.ldexp(other.cell(3).vertices, -power) == one.cell(3).vertices).all()


def test_a_region_with_many_faces():
    """Polytopes grow beyond the room that they begin with."""
    points = np.concatenate([np.zeros((1, 3)), on_sphere(600, 3)])
    inside = dt3d.Voronoi(points).clipped([[-2, -2, -2], [2, 2, 2]])
    assert math.fsum(inside.volumes) == pytest.approx(64, rel=1e-13)
    assert len(inside.cell(0).faces) == 600


def test_threads_change_nothing():
    points = RNG.random((3000, 3))
    one, all_of_them = (dt3d.Voronoi(points, threads=t).clipped() for t in (1, None))
    assert (one.volumes == all_of_them.volumes).all()
    assert (one.areas == all_of_them.areas).all()


@pytest.mark.parametrize(
    ("box", "message"),
    [
        ([0, 1], r"box must have shape \(2, 2\), its low and its high corner, got \(2,\)"),
        ([[0, 0, 0], [1, 1, 1]], r"box must have shape \(2, 2\), .* got \(2, 3\)"),
        ([[0, 0], [1, np.inf]], "box must be finite"),
        ([[0, 0], [1, 0]], "low corner of a box must be less than its high corner in each coordinate"),
        ([[1, 0], [0, 1]], "low corner of a box must be less"),
        ("unit", "box"),
    ],
)
def test_bad_boxes(box, message):
    vor = dt3d.Voronoi([[0, 0], [1, 0], [0, 1]])
    with pytest.raises(ValueError, match=message):
        vor.clipped(box)


def test_a_box_too_flat_to_be_measured():
    vor = dt3d.Voronoi([[0, 0], [1, 0], [0, 1]])
    inside = vor.clipped([[0, 0], [1e-150, 1e-150]])
    with pytest.raises(ValueError, match="is too flat or small to be measured"):
        inside.volumes  # noqa: B018


def test_sites_that_there_are_not():
    inside = dt3d.Voronoi([[0, 0], [1, 0], [0, 1]]).clipped()
    for k in (-1, 3):
        with pytest.raises(IndexError, match=f"there are sites 0 to 2, got {k}"):
            inside.cell(k)


def test_results_stay_as_they_were_computed():
    inside = dt3d.Voronoi([[0, 0], [1, 0], [0, 1]]).clipped()
    assert isinstance(inside, Clipped)
    for name in ("volumes", "areas", "box", "voronoi"):
        with pytest.raises(AttributeError, match=f"{name} cannot be assigned"):
            setattr(inside, name, None)
        with pytest.raises(AttributeError, match=f"{name} cannot be deleted"):
            delattr(inside, name)
    for array in (inside.volumes, inside.areas, inside.box):
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 1
    again = pickle.loads(pickle.dumps(inside))
    assert (again.volumes == inside.volumes).all()
    assert repr(again) == "<<dt3d.Voronoi: 3 sites in the plane> in [[0.0, 0.0], [1.0, 1.0]]>"

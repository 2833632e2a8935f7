"""`dt3d.Delaunay` against SciPy and against the exact oracle."""

import numpy as np
import pytest
import scipy.spatial

import dt3d
import scanvec as sv

from .exact import canonical, check_indices, check_neighbors, validate
from .families import SMALL, grid

MACHINES = {"device": sv.Device} | {f"P={p}": lambda p=p: sv.Simulated(processors=p) for p in (1, 3, 32, 100)}


def random_set(k, n):
    """Uniform, normal, in a ball, and clustered sets in turn; no five sites near a sphere on purpose."""
    rng = np.random.default_rng([k, n])
    points = rng.standard_normal((n, 3))
    if k % 4 == 0:
        return rng.random((n, 3))
    if k % 4 == 1:
        return points
    if k % 4 == 2:
        return points / np.linalg.norm(points, axis=1)[:, None] * rng.random((n, 1)) ** (1 / 3)
    return rng.random((8, 3))[rng.integers(8, size=n)] + 0.05 * points


def assert_equals_scipy(points, machine):
    tri = dt3d.Delaunay(points, machine=machine)
    want = canonical(scipy.spatial.Delaunay(points).simplices)
    np.testing.assert_array_equal(canonical(tri.simplices), want)
    check_indices(tri)
    check_neighbors(tri)
    corners = points[tri.simplices]
    assert (np.linalg.det(corners[:, 1:] - corners[:, :1]) > 0).all()
    assert tri.stats.inconsistencies == 0


# twenty sizes from 10 to 20,000
SIZES = np.unique(np.geomspace(10, 20_000, 20).round().astype(int)).tolist()


# each number of processors compiles kernels of its own; all of them at all sizes are slow
@pytest.mark.parametrize("machine", ["device", "P=3"])
@pytest.mark.parametrize(("k", "n"), [(k, n) for k, n in enumerate(SIZES) if n < 1200][::2])
def test_equals_scipy(k, n, machine):
    assert_equals_scipy(random_set(k, n), MACHINES[machine]())


@pytest.mark.slow
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(("k", "n"), list(enumerate(SIZES)))
def test_equals_scipy_at_twenty_sizes(k, n, machine):
    assert_equals_scipy(random_set(k, n), MACHINES[machine]())


@pytest.mark.slow
def test_five_thousand_sites_equal_scipys():
    assert_equals_scipy(random_set(0, 5000), sv.Device())


# cospherical and coplanar sites that a perturbation of 1e-9 decides in double precision
DECIDED = [
    "grid 4",
    "thin grid",
    "body-centred lattice",
    "integer sphere 81",
    "integer ball",
    "skew lines",
    "octahedron",
    "tetrahedron",
    "plane and apex",
    "duplicates",
]


@pytest.mark.parametrize("name", DECIDED)
def test_degenerate_sets_under_the_papers_perturbation(name):
    tri = dt3d.Delaunay(SMALL[name], robustness="perturb")
    validate(tri)
    assert tri.stats.inconsistencies == 0


def test_the_papers_cube():
    tri = dt3d.Delaunay(grid(7), robustness="perturb", machine=sv.Simulated(processors=32))
    assert len(tri.simplices) == 1296
    assert tri.stats.iterations == 5
    validate(tri)


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
@pytest.mark.parametrize("n", [4, 5, 30])
def test_few_sites(n, method):
    validate(dt3d.Delaunay(np.random.default_rng(n).random((n, 3)), method=method))


def test_methods_and_seeds_agree_on_sites_in_general_position():
    points = np.random.default_rng(3).random((200, 3))
    want = canonical(dt3d.Delaunay(points).simplices)
    for options in ({"seed": 7}, {"method": "extrapolation"}, {"robustness": "perturb", "seed": 7}):
        np.testing.assert_array_equal(canonical(dt3d.Delaunay(points, **options).simplices), want)


@pytest.mark.slow
def test_machines_report_the_same_counts():
    points = np.random.default_rng(4).random((300, 3))
    runs = [dt3d.Delaunay(points, machine=make()) for make in MACHINES.values()]
    first = runs[0]
    for run in runs[1:]:
        np.testing.assert_array_equal(run.simplices, first.simplices)
        np.testing.assert_array_equal(run.neighbors, first.neighbors)
        np.testing.assert_array_equal(run.iteration, first.iteration)
        for name in ("iterations", "face_expansions", "sites_searched", "tetrahedra_per_iteration"):
            assert getattr(run.stats, name) == getattr(first.stats, name)


def test_the_ledger_does_not_change_from_run_to_run():
    points = np.random.default_rng(5).random((120, 3))
    machines = [sv.Simulated(processors=3) for _ in range(2)]
    for machine in machines:
        dt3d.Delaunay(points, machine=machine)
    assert machines[0].ledger.entries == machines[1].ledger.entries
    phases = [row.phase for row in machines[0].ledger.table("phase")]
    assert phases == ["buckets", "first facets", "face expansion", "dead faces", "neighbors"]


def test_statistics():
    machine = sv.Simulated(processors=4)
    points = np.random.default_rng(6).random((400, 3))
    tri = dt3d.Delaunay(points, machine=machine)
    s = tri.stats
    assert s.ledger is machine.ledger
    assert s.iterations == len(s.tetrahedra_per_iteration)
    assert sum(s.tetrahedra_per_iteration) == len(tri.simplices)
    np.testing.assert_array_equal(
        np.bincount(tri.iteration, minlength=s.iterations + 1)[1:], s.tetrahedra_per_iteration
    )
    # every directed face is expanded, but those that meet an expanded one
    assert s.face_expansions >= len(tri.simplices) + len(tri.convex_hull)
    assert 1.45 < s.face_expansions / len(tri.simplices) < 1.65
    assert s.sites_searched / s.face_expansions < 80
    assert set(s.seconds) >= {"buckets", "face expansion", "total"}


def test_single_precision():
    points = np.random.default_rng(7).random((500, 3)).astype(np.float32)
    tri = dt3d.Delaunay(points, robustness="perturb", dtype=np.float32)
    validate_topology_only = (check_indices, check_neighbors)
    for check in validate_topology_only:
        check(tri)
    want = {tuple(s) for s in canonical(scipy.spatial.Delaunay(points.astype(float)).simplices).tolist()}
    got = {tuple(s) for s in canonical(tri.simplices).tolist()}
    # a perturbation of 2^-12 decides some of some 6,000 in-sphere tests otherwise
    assert len(want ^ got) < 0.02 * len(want)


@pytest.mark.slow
def test_real_sets_equal_scipys(shared_points):
    for name in ("pdb_1a8o", "md_fcc", "water_box", "pcl_bun0"):
        assert_equals_scipy(shared_points(name), sv.Device())

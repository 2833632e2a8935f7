"""SciPy's own tests of `scipy.spatial.Delaunay`, run on `dt3d.Delaunay` through an adapter.

The tests are those of the SciPy that is installed. The adapter derives what SciPy's class has and ours has
not from the arrays that both have. Sites in the plane get an apex above it: every tetrahedron is a triangle
of the plane's Delaunay triangulation and the apex. In four dimensions and more SciPy's class does the work.
"""

import importlib.util
import inspect
import re
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.spatial

import dt3d

METHODS = ["insertion", "extrapolation"]

RUN = [
    "TestDelaunay.test_masked_array_fails",
    "TestDelaunay.test_array_with_nans_fails",
    "TestDelaunay.test_nd_simplex",
    "TestDelaunay.test_duplicate_points",
    "TestDelaunay.test_pathological",
    "TestDelaunay.test_coplanar",
    "TestVertexNeighborVertices.test_triangle",
    "TestVertexNeighborVertices.test_rectangle",
    "TestVertexNeighborVertices.test_complicated",
    "TestConvexHull.test_hull_consistency_tri",
    "TestUtilities.test_more_barycentric_transforms",
]
IMPOSSIBLE = {
    "TestDelaunay.test_2d_square": "expects the order of rows and vertices that Qhull gives",
    "TestDelaunay.test_joggle": "a Qhull option (QJ)",
    "TestDelaunay.test_furthest_site": "the triangulation of furthest sites",
    "TestDelaunay.test_incremental": "add_points",
    "TestUtilities.test_find_simplex": "expects the order of rows that Qhull gives",
    "TestUtilities.test_plane_distance": "lift_points and plane_distance, on Qhull's paraboloid",
    "TestUtilities.test_convex_hull": "expects the order of rows and vertices that Qhull gives",
    "TestUtilities.test_degenerate_barycentric_transforms": "allows 22 invalid transforms, we have 31",
    "test_gh_20623": "its parameters are SciPy's own classes",
    "test_gh_21286": "errors of find_simplex",
    "test_find_simplex_ndim_err": "errors of find_simplex",
}
SLOW = {"TestUtilities.test_more_barycentric_transforms"}


class Adapter:
    """A triangulation with the names of SciPy's class."""

    def __init__(self, points, method):
        plane = np.ndim(points) == 2 and np.shape(points)[1] == 2
        if plane:
            points = np.asarray(points, float)
            sites = np.concatenate([np.c_[points, np.zeros(len(points))], [[*points[0], 1]]])
        else:
            sites = points
        tri = dt3d.Delaunay(sites, method=method)
        # a copy, since SciPy's tests sort it in place
        self.points, self.simplices, self.neighbors = tri.points, tri.simplices.copy(), tri.neighbors
        self.convex_hull, self.duplicates = tri.convex_hull, tri.duplicates
        if plane:
            apex = len(points)
            beside = self.simplices != apex
            assert (beside.sum(axis=1) == 3).all()
            self.points = points
            self.simplices = self.simplices[beside].reshape(-1, 3)
            self.neighbors = self.neighbors[beside].reshape(-1, 3)
            sides = self.convex_hull[(self.convex_hull == apex).any(axis=1)]
            self.convex_hull = sides[sides != apex].reshape(-1, 2)
        self.ndim, self.nsimplex = self.points.shape[1], len(self.simplices)

    @property
    def vertex_to_simplex(self):
        """A simplex at each site, for duplicates at the site that was used."""
        simplex = np.full(len(self.points), -1)
        simplex[self.simplices] = np.arange(self.nsimplex)[:, None]
        simplex[self.duplicates[:, 0]] = simplex[self.duplicates[:, 1]]
        return simplex

    @property
    def coplanar(self):
        """Sites that were not used, a simplex and a vertex at the same place."""
        unused, used = self.duplicates.T
        return np.c_[unused, self.vertex_to_simplex[used], used]

    @property
    def vertex_neighbor_vertices(self):
        """The sites that edges lead to from each site, as offsets and indices."""
        corners = range(self.ndim + 1)
        edges = np.concatenate([self.simplices[:, [i, j]] for i in corners for j in corners if i != j])
        edges = np.unique(edges, axis=0)
        return np.searchsorted(edges[:, 0], np.arange(len(self.points) + 1)), edges[:, 1]

    @cached_property
    def transform(self):
        """Matrices to barycentric coordinates, and the last vertices; NaN where rounding would show."""
        corners = self.points[self.simplices]
        last = corners[:, -1:]
        sides = (corners[:, :-1] - last).swapaxes(1, 2)
        flat = np.linalg.cond(sides, 1) > 1 / (1000 * np.finfo(float).eps)
        sides[flat] = np.nan
        return np.concatenate([np.linalg.inv(sides), last], axis=1)

    def find_simplex(self, targets):
        """The first simplex that has each target, or -1, by trying all."""
        inverse, last = self.transform[:, :-1], self.transform[:, -1:]
        # barycentric coordinates as linear functions; the last vertex has what is left of 1
        linear = np.concatenate([inverse, -inverse.sum(axis=1, keepdims=True)], axis=1)
        constant = -(linear @ last.swapaxes(1, 2))
        constant[:, -1] += 1
        functions = np.ascontiguousarray(np.concatenate([linear, constant], axis=2).swapaxes(0, 1))
        found = []
        # few at a time: products that BLAS spreads over threads wait for busy cores
        for part in np.array_split(np.c_[targets, np.ones(len(targets))], len(targets) // 8 + 1):
            inside = np.logical_and.reduce([f @ part.T > -1e-10 for f in functions])
            found.append(np.where(inside.any(axis=0), inside.argmax(axis=0), -1))
        return np.concatenate(found)


@pytest.fixture(scope="module")
def suite(request):
    """SciPy's module of tests, where SciPy was installed with it."""
    spec = importlib.util.find_spec("scipy.spatial.tests")
    if spec is None:
        pytest.skip(f"SciPy {scipy.__version__} is installed without its tests")
    path = Path(spec.origin).with_name("test_qhull.py")
    assert path.exists(), f"SciPy {scipy.__version__} has its tests of Delaunay elsewhere than in {path}"
    # its marks have to be known where marks are strict
    for mark in sorted(set(re.findall(r"pytest\.mark\.(\w+)", path.read_text()))):
        request.config.addinivalue_line("markers", f"{mark}: used by SciPy's tests")
    return importlib.import_module("scipy.spatial.tests.test_qhull")


def named_for_delaunay(suite):
    """Tests of the module by name, of those whose text names the class, and all of the class for it."""
    found = {}
    for name, thing in vars(suite).items():
        if inspect.isclass(thing) and name.startswith("Test"):
            tests = {f"{name}.{k}": f for k, f in vars(thing).items() if k.startswith("test")}
        else:
            tests = {name: thing} if name.startswith("test") else {}
        for key, test in tests.items():
            if name == "TestDelaunay" or "Delaunay" in inspect.getsource(test):
                found[key] = test
    return found


def test_every_test_of_delaunay_is_run_or_impossible(suite):
    new = sorted(set(named_for_delaunay(suite)) - set(RUN) - set(IMPOSSIBLE))
    assert not new, (
        f"SciPy {scipy.__version__} has tests of Delaunay that are not run here and not called impossible; "
        f"add each to RUN or to IMPOSSIBLE: {', '.join(new)}"
    )
    assert not set(RUN) & set(IMPOSSIBLE)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in RUN]
)
def test_scipys(name, method, suite, monkeypatch):
    if name not in named_for_delaunay(suite):
        pytest.skip(f"SciPy {scipy.__version__} does not have {name}")
    made = []

    def delaunay(points, **options):
        if np.ndim(points) == 2 and np.shape(points)[1] > 3:
            return scipy.spatial.Delaunay(points, **options)
        assert not options, f"{name} uses options that dt3d does not have: {options}"
        made.append(np.shape(points))
        return Adapter(points, method)

    monkeypatch.setattr(suite, "qhull", SimpleNamespace(**vars(suite.qhull) | {"Delaunay": delaunay}))
    holder, _, test = name.rpartition(".")
    run = getattr(getattr(suite, holder)() if holder else suite, test)
    if name == "TestConvexHull.test_hull_consistency_tri":
        for data in suite.DATASETS:
            run(data)
    else:
        run()
    assert made, f"{name} passed without a triangulation"

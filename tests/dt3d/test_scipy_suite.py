"""SciPy's own tests of `scipy.spatial.Delaunay`, run on `dt3d.Delaunay`, and on what its `to_scipy` gives.

The tests are those of the SciPy that is installed. In four dimensions and more SciPy's class does the work.
"""

import importlib.util
import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.spatial

import dt3d

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
    "TestDelaunay.test_incremental",
    "TestUtilities.test_more_barycentric_transforms",
    "TestUtilities.test_plane_distance",
    "test_find_simplex_ndim_err",
    "test_gh_20623",
    "test_gh_21286",
]
IMPOSSIBLE = {
    "TestDelaunay.test_2d_square": "expects the order of rows and vertices that Qhull gives",
    "TestDelaunay.test_joggle": "option QJ moves the sites, which is refused",
    "TestDelaunay.test_furthest_site": "furthest_site=True is refused",
    "TestUtilities.test_find_simplex": "expects the order of rows that Qhull gives",
    "TestUtilities.test_convex_hull": "expects the order of rows and vertices that Qhull gives",
    "TestUtilities.test_degenerate_barycentric_transforms": "allows 22 slivers with NaN, there are more",
}
# of the two classes
ONLY_AS_SCIPY = {
    "TestDelaunay.test_nd_simplex": "sorts the simplices in place, and ours are read-only",
    "test_gh_21286": "expects an IndexError for wrong shapes, ours is a ValueError",
}
# what SciPy's class gets is finished
FINISHED = ("to_scipy", "TestDelaunay.test_incremental")
SLOW = {"TestUtilities.test_more_barycentric_transforms"}
CLASSES = ["dt3d.Delaunay", "to_scipy"]


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


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        pytest.param(name, kind, marks=[pytest.mark.slow] if name in SLOW else [])
        for name in RUN
        for kind in CLASSES
        if (kind == "to_scipy" or name not in ONLY_AS_SCIPY) and (kind, name) != FINISHED
    ],
)
def test_scipys(name, kind, suite, monkeypatch):
    if name not in named_for_delaunay(suite):
        pytest.skip(f"SciPy {scipy.__version__} does not have {name}")
    made = []

    def delaunay(points, *args, **options):
        if np.ndim(points) == 2 and np.shape(points)[1] > 3:
            return scipy.spatial.Delaunay(points, *args, **options)
        made.append(np.shape(points))
        tri = dt3d.Delaunay(points, *args, **options)
        return tri if kind == "dt3d.Delaunay" else tri.to_scipy()

    monkeypatch.setattr(suite, "qhull", SimpleNamespace(**vars(suite.qhull) | {"Delaunay": delaunay}))
    holder, _, test = name.rpartition(".")
    run = getattr(getattr(suite, holder)() if holder else suite, test)
    if name == "TestConvexHull.test_hull_consistency_tri":
        for data in suite.DATASETS:
            run(data)
    elif name == "TestDelaunay.test_incremental":
        for data, (_, options) in suite.INCREMENTAL_DATASETS.items():
            if options is None:  # the others move the sites
                run(data)
    elif name == "test_gh_20623":
        run(delaunay)
    else:
        run()
    assert made, f"{name} passed without a triangulation"

"""SciPy's own tests of its interpolators, run on ours, from the SciPy that is installed."""

import importlib.util
import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
import scipy

import dt3d
from dt3d.interpolate import Linear, NaturalNeighbor, Nearest

MODULES = {"interpnd": "TestLinearNDInterpolation", "ndgriddata": "TestNearestNDInterpolator"}
IMPOSSIBLE = {
    "test_nearest_options": "options of SciPy's k-d tree",
    "test_nearest_query_options": "options of SciPy's k-d tree",
    "test_nearest_query_valid_inputs": "options of SciPy's k-d tree",
    "test_concurrency": "its sites are on a line, where there is no triangulation",
}
SLOW = {"test_threading"}


def module_of(name, config):
    spec = importlib.util.find_spec("scipy.interpolate.tests")
    if spec is None:
        pytest.skip(f"SciPy {scipy.__version__} is installed without its tests")
    path = Path(spec.origin).with_name(f"test_{name}.py")
    for mark in sorted(set(re.findall(r"pytest\.mark\.(\w+)", path.read_text()))):
        config.addinivalue_line("markers", f"{mark}: used by SciPy's tests")
    return importlib.import_module(f"scipy.interpolate.tests.test_{name}")


def named_in(module, holder):
    return {name: f for name, f in inspect.getmembers(getattr(module, holder)) if name.startswith("test")}


RUN = {
    "interpnd": [
        "test_complex_smoketest", "test_pickle", "test_smoketest", "test_smoketest_alternate",
        "test_smoketest_rescale", "test_square", "test_square_rescale", "test_threading", "test_tri_input",
        "test_tri_input_rescale", "test_tripoints_input_rescale",
    ],
    "ndgriddata": ["test_nearest_list_argument"],
}  # fmt: skip


@pytest.mark.parametrize("name", MODULES)
def test_every_test_is_run_or_impossible(name, request):
    found = set(named_in(module_of(name, request.config), MODULES[name]))
    new = sorted(found - set(RUN[name]) - set(IMPOSSIBLE))
    assert not new, f"SciPy {scipy.__version__} has tests that are neither run nor called impossible: {new}"


@pytest.mark.parametrize(
    ("name", "test"),
    [
        pytest.param(name, test, marks=[pytest.mark.slow] if test in SLOW else [])
        for name, tests in RUN.items()
        for test in tests
    ],
)
def test_scipys(name, test, request, monkeypatch):
    module = module_of(name, request.config)
    if test not in named_in(module, MODULES[name]):
        pytest.skip(f"SciPy {scipy.__version__} does not have {test}")
    if name == "interpnd":
        monkeypatch.setattr(module, "interpnd", SimpleNamespace(LinearNDInterpolator=Linear))
        monkeypatch.setattr(module, "qhull", SimpleNamespace(Delaunay=dt3d.Delaunay))
    else:
        monkeypatch.setattr(module, "NearestNDInterpolator", Nearest)
    getattr(getattr(module, MODULES[name])(), test)()


@pytest.mark.parametrize("kind", [Linear, Nearest, NaturalNeighbor])
@pytest.mark.parametrize("test", ["test_broadcastable_input", "test_read_only"])
def test_scipys_of_all_interpolators(test, kind, request):
    getattr(module_of("ndgriddata", request.config).TestNDInterpolators(), test)(kind)

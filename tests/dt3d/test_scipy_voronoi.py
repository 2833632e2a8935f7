"""SciPy's own tests of `scipy.spatial.Voronoi` and its plot, run on `dt3d.Voronoi`.

The tests are those of the SciPy that is installed. In four dimensions and more SciPy's class does the work.
"""

import importlib
import importlib.util
import inspect
import itertools
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.spatial

import dt3d

RUN = [
    "TestVoronoi.test_point_region_structure",
    "TestVoronoi.test_masked_array_fails",
    "TestVoronoi.test_ridges",
    "Test_Qhull.test_issue_8051",
    "TestPlotting.test_voronoi",
    "test_gh_20623",
]
IMPOSSIBLE = {
    "TestVoronoi.test_simple": "expects the order of vertices, and of those of regions, that Qhull gives; "
    "the same figures in any order are in test_diagram.py",
    "TestVoronoi.test_furthest_site": "furthest_site=True is refused",
    "TestVoronoi.test_furthest_site_flag": "furthest_site=True is refused",
    "TestVoronoi.test_incremental": "incremental=True is refused",
    "TestPlotting.test_gh_19653": "expects the order of ridges that Qhull gives; the same segments in any "
    "order are in test_plot.py",
    "TestPlotting.test_gh_19653_smaller_aspect": "expects the order of ridges that Qhull gives",
}
# parameters of those that are run
EXCEPT = {
    (
        "TestVoronoi.test_ridges",
        "pathological-2",
    ): "exactly it has ridges that end at y = -4.5e15, where distances "
    "in doubles do not tell which site is nearest"
}
MODULES = ["test_qhull", "test__plotutils"]


@pytest.fixture(scope="module")
def suites(request):
    """SciPy's modules of tests, where SciPy was installed with them."""
    spec = importlib.util.find_spec("scipy.spatial.tests")
    if spec is None:
        pytest.skip(f"SciPy {scipy.__version__} is installed without its tests")
    for module in MODULES:
        path = Path(spec.origin).with_name(f"{module}.py")
        assert path.exists(), f"SciPy {scipy.__version__} has its tests of Voronoi elsewhere than in {path}"
        # its marks have to be known where marks are strict
        for mark in sorted(set(re.findall(r"pytest\.mark\.(\w+)", path.read_text()))):
            request.config.addinivalue_line("markers", f"{mark}: used by SciPy's tests")
    return [importlib.import_module(f"scipy.spatial.tests.{module}") for module in MODULES]


def named_for_voronoi(suites):
    """The module and the function of each test whose text names the class, by name."""
    found = {}
    for suite in suites:
        for name, thing in vars(suite).items():
            if inspect.isclass(thing) and name.startswith("Test"):
                tests = {f"{name}.{k}": f for k, f in vars(thing).items() if k.startswith("test")}
            else:
                tests = {name: thing} if name.startswith("test") else {}
            for key, test in tests.items():
                if name == "TestVoronoi" or "Voronoi" in inspect.getsource(test):
                    found[key] = suite, test
    return found


def cases(test):
    """The arguments of a test by name, one dictionary for each combination of its parameters."""
    marks = [mark for mark in getattr(test, "pytestmark", ()) if mark.name == "parametrize"]
    sets = []
    for mark in marks:
        names = mark.args[0] if isinstance(mark.args[0], str) else ",".join(mark.args[0])
        names = [name.strip() for name in names.split(",")]
        sets.append([dict(zip(names, v if len(names) > 1 else [v], strict=True)) for v in mark.args[1]])
    return [{k: v for part in parts for k, v in part.items()} for parts in itertools.product(*sets)]


def test_every_test_of_voronoi_is_run_or_impossible(suites):
    new = sorted(set(named_for_voronoi(suites)) - set(RUN) - set(IMPOSSIBLE))
    assert not new, (
        f"SciPy {scipy.__version__} has tests of Voronoi that are not run here and not called impossible; "
        f"add each to RUN or to IMPOSSIBLE: {', '.join(new)}"
    )
    assert not set(RUN) & set(IMPOSSIBLE)


@pytest.mark.parametrize("name", RUN)
def test_scipys(name, suites, monkeypatch):
    tests = named_for_voronoi(suites)
    if name not in tests:
        pytest.skip(f"SciPy {scipy.__version__} does not have {name}")
    suite, test = tests[name]
    made = []

    def voronoi(points, *args, **options):
        if np.ndim(points) == 2 and np.shape(points)[1] > 3:
            return scipy.spatial.Voronoi(points, *args, **options)
        made.append(np.shape(points))
        return dt3d.Voronoi(points, *args, **options)

    monkeypatch.setattr(suite, "Voronoi", voronoi)
    if hasattr(suite, "qhull"):
        monkeypatch.setattr(suite, "qhull", SimpleNamespace(**vars(suite.qhull) | {"Voronoi": voronoi}))
    holder, _, function = name.rpartition(".")
    run = getattr(getattr(suite, holder)() if holder else suite, function)
    for case in cases(test):
        if any((name, value) in EXCEPT for value in case.values()):
            continue
        run(**({"diagram_type": voronoi} if "diagram_type" in case else case))
    assert made, f"{name} passed without a diagram"

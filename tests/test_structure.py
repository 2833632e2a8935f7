"""How the code is built: types, sizes, imports, tests named after modules, and a line for every file.

Figures that a test can count are limits here, and each failure lists where they are exceeded.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from pathlib import PurePosixPath

import pytest

from .structure import (
    ROOT,
    Source,
    any_parameters,
    circles,
    file_rows,
    import_graph,
    kernels,
    lines,
    parameters,
    private_names,
    raw_indices,
    sources,
    untyped,
)

MOST_ANY = 60  # parameters, in both packages together; each says beside it why no other type is true
MOST_LINES = 80
MOST_PARAMETERS = 8

SOURCES = sources()
NAMES = {source.name for source in SOURCES}

# the modules of these have tests of their own; the rest is tested from outside
ENGINES = {
    "scanvec": "scanvec",
    "dt3d/insertion": "insertion",
    "dt3d/extrapolation": "extrapolation",
    "dt3d/threaded2d": "threaded2d",
    "dt3d/predicates": "predicates",
    "dt3d/ordering": "ordering",
    "dt3d/_numba": "numba_tools",
}

# imports in functions that may go round: the cache is made from numba, which loads when it is first used
LAZY = [["dt3d._numba.kernel_cache", "dt3d._numba.numba_cache"]]

# arrays of the insertion in space, whose layout one module knows
ARRAYS = {"mesh", "tetrahedra", "sites", "labels", "spheres", "radii"}
LAYOUT = "dt3d/insertion/mesh.py"


def test_few_parameters_are_any():
    found = {source.path: any_parameters(source) for source in SOURCES}
    counts = Counter({path: len(names) for path, names in found.items() if names})
    total = sum(counts.values())
    assert total < MOST_ANY, f"{total} parameters are Any:\n" + "\n".join(
        f"{count:4} {path}: {', '.join(found[path])}" for path, count in counts.most_common()
    )


def test_only_kernels_are_untyped():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["mypy"]
    (lenient,) = (part for part in settings["overrides"] if "disallow_untyped_defs" in part)
    with_kernels = {source.name for source in SOURCES if kernels(source)}
    assert settings["strict"]
    assert lenient["module"] == sorted(with_kernels)
    wrong = [
        f"{source.path}: {function.name} ({', '.join(untyped(function))})"
        for source in SOURCES
        if source.name in with_kernels
        for function in set(source.functions()) - kernels(source)
        if untyped(function)
    ]
    assert not wrong, _listed(sorted(wrong))


def test_functions_fit_on_a_page():
    long = [
        f"{source.path}: {function.name} has {lines(function)} lines"
        for source in SOURCES
        for function in source.functions()
        if lines(function) > MOST_LINES
    ]
    assert not long, _listed(long)


def test_functions_have_few_parameters():
    many = [
        f"{source.path}: {function.name} has {len(parameters(function))} parameters"
        for source in SOURCES
        for function in source.functions()
        if len(parameters(function)) > MOST_PARAMETERS
    ]
    assert not many, _listed(many)


def test_private_names_stay_in_their_modules():
    taken = [f"{source.path}: {name}" for source in SOURCES for name in private_names(source, NAMES)]
    assert not taken, _listed(taken)


def test_imports_have_no_circle():
    found = circles(import_graph(SOURCES))
    # in an engine an import within a function does not open a circle, either
    found += [
        circle
        for circle in circles(import_graph(SOURCES, "module", "call"))
        if circle not in LAZY
        and any(
            f"{name.replace('.', '/')}/".startswith(f"{engine}/") for name in circle for engine in ENGINES
        )
    ]
    assert not found, _listed([" ".join(circle) for circle in found])


def test_the_layout_of_a_tetrahedron_is_known_to_one_module():
    assert any(source.path == LAYOUT for source in SOURCES)
    raw = [
        f"{source.path}, {index}"
        for source in SOURCES
        if source.path.startswith("dt3d/insertion/") and source.path != LAYOUT
        for index in raw_indices(source, ARRAYS)
    ]
    assert not raw, _listed(raw)


def test_every_module_of_an_engine_has_tests_named_after_it():
    tests = [path.relative_to(ROOT).as_posix() for path in (ROOT / "tests").rglob("test_*.py")]
    missing = [
        f"{source.path}: no test_{module}.py below a folder {engine} of tests/"
        for folder, engine in ENGINES.items()
        for source in SOURCES
        if source.path.startswith(f"{folder}/") and not source.path.endswith("__init__.py")
        for module in [PurePosixPath(source.path).stem.lstrip("_")]
        if not any(
            f"/{engine}/" in test.replace("/_", "/") and test.endswith(f"/test_{module}.py") for test in tests
        )
    ]
    assert not missing, _listed(missing)


def test_every_module_is_a_row_of_the_nearest_page():
    pages = {
        path.parent.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
        for package in ("scanvec", "dt3d")
        for path in (ROOT / package).rglob("README.md")
    }
    rows = Counter(f"{folder}/{file}" for folder, text in pages.items() for file in file_rows(text))
    modules = {source.path for source in SOURCES}
    expected = {path for path in modules if not path.endswith("__init__.py")}
    wrong = [f"{path} is named {rows[path]} times" for path in sorted(expected) if rows[path] != 1]
    wrong += [f"{path} does not exist" for path in sorted(rows.keys() - modules)]
    wrong += [
        f"{path} is not named by the nearest page, that of {_nearest(path, pages)}"
        for path in sorted(expected & rows.keys())
        if PurePosixPath(path).relative_to(_nearest(path, pages)).as_posix()
        not in file_rows(pages[_nearest(path, pages)])
    ]
    assert not wrong, _listed(wrong)


def test_imports_are_those_of_the_architecture():
    """The table of who may import whom; modules of dt3d whose names begin with an underscore serve all."""
    table = _allowed()
    assert {"scanvec", "dt3d/predicates", "dt3d/insertion", "dt3d/extrapolation"} <= table.keys()
    wrong = []
    for source in SOURCES:
        part = _part(source.name)
        if part not in table:
            continue
        for imported in source.imports():
            whole = f"{imported.module}.{imported.name}"
            other = _part(whole if whole in NAMES else imported.module)
            serves_all = other.startswith("dt3d/_") and source.name.startswith("dt3d.")
            if other and other != part and not serves_all and other not in table[part]:
                wrong.append(f"{source.path} imports {other}")
    assert not wrong, _listed(sorted(set(wrong)))


# what the helpers find in a bad source

BAD = """
from typing import TYPE_CHECKING, Any
from .other import _hidden, shown, _module
from . import other
if TYPE_CHECKING:
    from .later import Later

def many(a, b, /, c, d, *args, e, f, g, **options): ...

def typed(self, value: Any, pairs: dict[str, "Any"], Anything: int) -> Any:
    from .inside import thing
    return other._secret + other.__doc__ + other.open + _module._own

@intrinsic
def compiled(context, a: int) -> int:
    def codegen(b): ...

accessor = cached_njit(inline="always")

@numba.njit(cache=True)
def kernel(a): ...

@accessor
def word(a): ...

class Long:
    @staticmethod
    def long(n: int):
        mesh[8 * n + 4 + 1] = mesh[n] + spheres[n * 4] + self.mesh[2 * (8 * n)]
        k = 8 * n
        return other_array[8 * n] + mesh[k + 1]
"""


def test_what_the_helpers_count():
    bad = Source("p.bad", "p/bad.py", BAD)
    assert any_parameters(bad) == ["typed(value)", "typed(pairs)"]
    sizes = {f.name: (len(parameters(f)), lines(f)) for f in bad.functions()}
    assert sizes == {
        "many": (9, 1),
        "typed": (3, 3),
        "compiled": (2, 2),
        "codegen": (1, 1),
        "kernel": (1, 1),
        "word": (1, 1),
        "long": (1, 4),
    }
    assert {function.name for function in kernels(bad)} == {"compiled", "codegen", "kernel", "word"}
    assert [untyped(function) for function in kernels(bad) if function.name == "compiled"] == [["context"]]
    modules = {"p.bad", "p.other", "p.other._module"}
    taken = ["p.other._hidden", "p.other._module._own", "p.other._secret"]
    assert sorted(private_names(bad, modules)) == taken
    assert {index.partition(": ")[2] for index in raw_indices(bad, {"mesh", "spheres"})} == {
        "mesh[8 * n + 4 + 1]",
        "spheres[n * 4]",
        "self.mesh[2 * (8 * n)]",
        "mesh[k + 1]",
    }
    assert file_rows("| file | |\n|---|---|\n| `a/b.py` | what |\n| x | `c.py` |\n| `d.py` | |") == [
        "a/b.py",
        "d.py",
    ]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("from .b import f", [["p.a", "p.b"]]),
        ("from . import b", [["p.a", "p.b"]]),
        ("import p.b", [["p.a", "p.b"]]),
        ("from p.b import f", [["p.a", "p.b"]]),
        ("if True:\n    from .b import f", [["p.a", "p.b"]]),
        ("class A:\n    from .b import f", [["p.a", "p.b"]]),
        ("def late():\n    from .b import f", []),
        ("if TYPE_CHECKING:\n    from .b import f", []),
        ("from .c import f", []),
    ],
)
def test_which_imports_make_a_circle(body, expected):
    modules = [
        Source("p.a", "p/a.py", body),
        Source("p.b", "p/b.py", "from .a import g"),
        Source("p.c", "p/c.py", ""),
    ]
    assert circles(import_graph(modules)) == expected
    in_functions = [["p.a", "p.b"]] if "def" in body else expected
    assert circles(import_graph(modules, "module", "call")) == in_functions


def _nearest(path: str, pages: dict[str, str]) -> str:
    return next(str(folder) for folder in PurePosixPath(path).parents if str(folder) in pages)


def _listed(found: list[str]) -> str:
    return f"{len(found)}:\n" + "\n".join(found)


def _part(module: str) -> str:
    """The package of a module, or a module at the top of dt3d itself; "" for what is not ours."""
    first, _, rest = module.partition(".")
    if first == "dt3d" and rest:
        return f"dt3d/{rest.partition('.')[0]}"
    return first if first in ("scanvec", "dt3d") else ""


def _allowed() -> dict[str, set[str]]:
    """From ARCHITECTURE.md: for each part the parts that it may import."""
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    table = text.partition("| may import |\n")[2].partition("\n\n")[0]
    allowed = {}
    for row in table.splitlines()[1:]:
        parts, imported = (re.findall(r"`([^`]+)`", cell) for cell in row.strip("|").split("|")[:2])
        for part in parts:
            allowed[_named(part)] = {_named(name) for name in imported}
    return allowed


def _named(part: str) -> str:
    part = part.rstrip("/").removesuffix(".py")
    return part if part == "scanvec" else f"dt3d/{part}"

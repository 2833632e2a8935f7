"""The two packages as syntax trees: their modules, functions, imports, and the tables that name them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("scanvec", "dt3d")

# decorators whose functions numba compiles or calls while it compiles
COMPILED = {
    "cached_njit",
    "njit",
    "jit",
    "intrinsic",
    "overload",
    "register_jitable",
    "guvectorize",
    "vectorize",
}

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Import:
    """One name that one module imports from another: ``from module import name``, or ``import module``."""

    module: str
    name: str
    when: str  # "module": when the module is; "call": in a function; "typing": never, for type checkers


@dataclass(frozen=True)
class Source:
    """A module: its dotted name, its path below the root, and its text."""

    name: str
    path: str
    text: str

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text)

    @property
    def package(self) -> str:
        return self.name if self.path.endswith("__init__.py") else self.name.rpartition(".")[0]

    def functions(self) -> Iterator[Function]:
        return (node for node in ast.walk(self.tree) if isinstance(node, Function))

    def imports(self) -> Iterator[Import]:
        """All that it imports, wherever."""
        return _imports_of(self.tree.body, self.package, "module")


def sources() -> list[Source]:
    """All modules of both packages."""
    found = []
    for path in sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py")):
        relative = path.relative_to(ROOT)
        parts = [part for part in relative.with_suffix("").parts if part != "__init__"]
        found.append(Source(".".join(parts), relative.as_posix(), path.read_text(encoding="utf-8")))
    return found


def parameters(function: Function) -> list[ast.arg]:
    """All parameters but self and cls; ``*args`` and ``**options`` are one each."""
    a = function.args
    named = [*a.posonlyargs, *a.args, *a.kwonlyargs, *(arg for arg in (a.vararg, a.kwarg) if arg)]
    return [arg for arg in named if arg.arg not in ("self", "cls")]


def any_parameters(source: Source) -> list[str]:
    """The parameters whose annotation has `Any` in it, as ``function(parameter)``."""
    return [
        f"{function.name}({arg.arg})"
        for function in source.functions()
        for arg in parameters(function)
        if arg.annotation is not None and re.search(r"\bAny\b", ast.unparse(arg.annotation))
    ]


def lines(function: Function) -> int:
    """The lines of a function from ``def`` to its end; its decorators are not counted."""
    return (function.end_lineno or function.lineno) - function.lineno + 1


def kernels(source: Source) -> set[Function]:
    """The functions that numba compiles, and those within them: their types are inferred."""
    own = {
        target.id
        for node in ast.walk(source.tree)
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)
        for target in node.targets
        if isinstance(target, ast.Name) and _decorator(node.value) in COMPILED
    }
    outer = {
        f for f in source.functions() if {_decorator(node) for node in f.decorator_list} & (COMPILED | own)
    }
    return {inner for f in outer for inner in ast.walk(f) if isinstance(inner, Function)}


def untyped(function: Function) -> list[str]:
    """The parameters without an annotation, and "return" where that has none."""
    missing = [arg.arg for arg in parameters(function) if arg.annotation is None]
    return missing if function.returns is not None else [*missing, "return"]


def private_names(source: Source, modules: set[str]) -> list[str]:
    """The names with a leading underscore that it takes from other modules of ours; modules may be named so.

    Both ``from .other import _name`` and ``other._name`` count.
    """
    taken, aliases = [], {}
    for imported in source.imports():
        whole = f"{imported.module}.{imported.name}"
        if whole in modules:
            aliases[imported.name] = whole
        elif imported.module in modules and _private(imported.name):
            taken.append(whole)
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and _private(node.attr):
            whole = f"{aliases.get(node.value.id)}.{node.attr}"
            if node.value.id in aliases and whole not in modules:
                taken.append(whole)
    return taken


def circles(graph: dict[str, set[str]]) -> list[list[str]]:
    """The sets of nodes that reach each other and themselves: Tarjan's strongly connected components."""
    number: dict[str, int] = {}
    least: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(node: str) -> None:
        number[node] = least[node] = len(number)
        stack.append(node)
        for other in sorted(graph.get(node, ())):
            if other not in number:
                visit(other)
                least[node] = min(least[node], least[other])
            elif other in stack:
                least[node] = min(least[node], number[other])
        if least[node] == number[node]:
            component = stack[stack.index(node) :]
            del stack[stack.index(node) :]
            if len(component) > 1 or node in graph.get(node, ()):
                found.append(sorted(component))

    for node in sorted(graph):
        if node not in number:
            visit(node)
    return found


def import_graph(modules: list[Source], *when: str) -> dict[str, set[str]]:
    """For each module the modules that it imports then, at module level unless it is said.

    The packages of which a module is a part are left out: Python has begun them before it.
    """
    names = {source.name for source in modules}
    graph: dict[str, set[str]] = {}
    for source in modules:
        wanted = {
            f"{i.module}.{i.name}" if f"{i.module}.{i.name}" in names else i.module
            for i in source.imports()
            if i.when in (when or ("module",))
        }
        graph[source.name] = {name for name in wanted & names if not f"{source.name}.".startswith(f"{name}.")}
    return graph


def raw_indices(source: Source, arrays: set[str]) -> list[str]:
    """The subscripts of these arrays, by their last names, whose index is a product with 4 or 8.

    The product may have been put into a variable before: ``t = 8 * slot; mesh[t + 4]``.
    """
    products = {
        target.id
        for node in ast.walk(source.tree)
        if isinstance(node, ast.Assign) and _multiplies(node.value)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    return [
        f"line {node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(source.tree)
        if isinstance(node, ast.Subscript)
        and _last_name(node.value) in arrays
        and (_multiplies(node.slice) or products & _names(node.slice))
    ]


def file_rows(text: str) -> list[str]:
    """The files of a page's tables: the first cells of rows that are a path in backticks, ending in .py."""
    return re.findall(r"^\| *`([\w/]+\.py)` *\|", text, re.MULTILINE)


def _decorator(node: ast.expr) -> str:
    return _last_name(node.func if isinstance(node, ast.Call) else node)


def _private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__")


def _last_name(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def _names(node: ast.expr) -> set[str]:
    return {name.id for name in ast.walk(node) if isinstance(name, ast.Name)}


def _multiplies(value: ast.expr) -> bool:
    return any(
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Mult)
        and any(isinstance(side, ast.Constant) and side.value in (4, 8) for side in (node.left, node.right))
        for node in ast.walk(value)
    )


def _imports_of(body: list[ast.stmt], package: str, when: str) -> Iterator[Import]:
    for node in body:
        if isinstance(node, ast.Import):
            yield from (Import(alias.name, "", when) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (Import(_target(node, package), alias.name, when) for alias in node.names)
        else:
            typing = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
            inside = "call" if isinstance(node, Function) else "typing" if typing else when
            for part in ("body", "handlers", "cases", "orelse", "finalbody"):
                then = when if part == "orelse" else inside
                yield from _imports_of(getattr(node, part, []), package, then)


def _target(node: ast.ImportFrom, package: str) -> str:
    base = package.split(".")
    base = base[: len(base) - node.level + 1] if node.level else []
    return ".".join([*base, *([node.module] if node.module else [])])

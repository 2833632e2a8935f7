"""``dt3d info``: what a report of a fault should say, and whether first calls will wait."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from rich.table import Table
from rich.text import Text

import dt3d

from .._memory import available_memory, gigabytes
from .._numba.cores import available_cores
from .._numba.kept import CURE
from .._status import one_line
from .reporting import Reporting, Speaker

NEEDED = ("numpy", "numba", "llvmlite", "scipy", "jax", "jaxlib", "cyclopts", "rich")
OPTIONAL = {
    "pyvista": "view", "vtk": "view", "matplotlib": "view", "meshio": "view",
    "laspy": "formats", "lz4": "formats", "gemmi": "formats",
}  # fmt: skip
"""Packages, and the extra of dt3d's that brings them."""


def info(*, reporting: Reporting = Reporting()) -> None:  # noqa: B008  frozen
    """Print versions, cores, memory, and how much is compiled already; for reports of faults.

    Parameters
    ----------
    reporting
        What is said of it.
    """
    import platform

    speaker = Speaker(reporting)
    packages = {name: _version(name) for name in (*NEEDED, *OPTIONAL)}
    folder, compiled = _compiled()
    rows = {
        "dt3d": f"{dt3d.__version__} in {Path(dt3d.__file__).parent}",
        "Python": f"{platform.python_version()} in {sys.executable}",
        "system": platform.platform(),
        "cores": f"{available_cores()} of {os.cpu_count()}",
        "memory": f"{gigabytes(available_memory())} available",
    }
    for name, version in packages.items():
        way = f": pip install 'dt3d[{OPTIONAL[name]}]'" if name in OPTIONAL else ""
        rows[name] = version or f"not installed{way}"
    rows["compiled"] = f"{compiled} functions" if compiled else "nothing yet: dt3d warmup"
    rows["kept in"] = folder
    table = Table(show_header=False)
    table.add_column("what")
    table.add_column("value", overflow="fold")
    for name, value in rows.items():
        table.add_row(name, Text(one_line(value)), end_section=name in ("memory", [*packages][-1]))
    speaker.show(table)
    speaker.result(
        {
            "dt3d": dt3d.__version__,
            "python": platform.python_version(),
            "system": platform.platform(),
            "cores": available_cores(),
            "available_memory": available_memory(),
            "packages": packages,
            "compiled_functions": compiled,
            "cache": folder,
        }
    )


def _version(package: str) -> str | None:
    """The version that is installed; nothing of it is loaded."""
    import importlib.metadata  # loads much, and each command would wait for it

    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def _compiled() -> tuple[str, int]:
    """Where numba keeps what it compiles of dt3d, and how many functions are there."""
    from ..predicates.lexicographic import before  # one of many, and small

    path = getattr(getattr(before, "_cache", None), "cache_path", None)
    if path is None:
        return f"no folder that can be written; {CURE}", 0
    package, chosen = Path(dt3d.__file__).parent, os.environ.get("NUMBA_CACHE_DIR")
    if package in Path(path).parents:
        return str(package / "**" / "__pycache__"), sum(1 for _ in package.rglob("__pycache__/*.nbi"))
    folder = Path(chosen) if chosen else Path(path).parent
    return str(folder), sum(1 for _ in folder.rglob("*.nbi"))

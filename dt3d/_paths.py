"""What must be true of a path before it is read or written, and the packages that files need."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

from scanvec._writing import check_writable, written_aside

from ._mesh import INSTALL_VIEW

__all__ = [
    "by_extension",
    "check_apart",
    "check_file",
    "check_writable",
    "import_for_format",
    "import_meshio",
    "written_aside",
]

INSTALL_FORMATS = "install it with: pip install 'dt3d[formats]'"

F = TypeVar("F", bound=Callable)


def check_file(path: Path) -> Path:
    """The path, if there is such a file; otherwise a FileNotFoundError."""
    if not path.exists():
        msg = f"there is no file {path}"
        raise FileNotFoundError(msg)
    return path


def check_apart(written: Path, other: Path, way_out: str = "name another file") -> None:
    """A ValueError if what is to be written is another file of the same command, by links too."""
    with suppress(OSError):  # there is no such file yet
        if written.samefile(other):
            msg = f"{written} and {other} are one file, which would be replaced; {way_out}"
            raise ValueError(msg)
    if os.path.realpath(written) == os.path.realpath(other):
        msg = f"{written} and {other} would be one file; {way_out}"
        raise ValueError(msg)


def by_extension(path: Path, table: dict[str, F], verb: str) -> F:
    """The table's entry for the extension, in any case; otherwise a ValueError that lists the known ones."""
    try:
        return table[path.suffix.lower()]
    except KeyError:
        msg = f"cannot {verb} {path}: unknown extension {path.suffix!r}; known are {', '.join(sorted(table))}"
        raise ValueError(msg) from None


def import_meshio() -> Any:
    """meshio, or an ImportError that says how to install it."""
    try:
        import meshio
    except ImportError as error:
        msg = f"this needs meshio, which cannot be loaded ({error}); {INSTALL_VIEW}"
        raise ImportError(msg) from error
    return meshio


def import_for_format(module: str) -> Any:
    """A module that a format needs, or an ImportError that says how to install it."""
    try:
        return import_module(module)
    except ImportError as error:
        msg = f"this file needs the package {module.partition('.')[0]} ({error}); {INSTALL_FORMATS}"
        raise ImportError(msg) from error

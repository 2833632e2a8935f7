"""What must be true of a path before it is read or written, and the packages that files need."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from ._mesh import INSTALL_VIEW

F = TypeVar("F", bound=Callable)

INSTALL_FORMATS = "install it with: pip install 'dt3d[formats]'"


def check_file(path: Path) -> Path:
    """The path, if there is such a file; otherwise a FileNotFoundError."""
    if not path.exists():
        msg = f"there is no file {path}"
        raise FileNotFoundError(msg)
    return path


def check_folder(path: Path) -> Path:
    """The path, if its folder exists; otherwise a FileNotFoundError."""
    if not path.parent.is_dir():
        msg = f"cannot write {path}: there is no folder {path.parent}"
        raise FileNotFoundError(msg)
    return path


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


def import_gemmi() -> Any:
    """Gemmi, or an ImportError that says how to install it."""
    try:
        import gemmi
    except ImportError as error:
        msg = f"this needs gemmi, which cannot be loaded ({error}); {INSTALL_FORMATS}"
        raise ImportError(msg) from error
    return gemmi

"""Packages that some calls need and `dt3d` itself does not: each is loaded when a call first needs it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

EXTRAS = {
    "pyvista": "view",
    "matplotlib": "view",
    "meshio": "view",
}  # of dt3d's; those of files are in "formats"
NAMES = {"pyvista": "PyVista"}


def optional(module: str, purpose: str = "this") -> Any:
    """A module of a package that need not be installed.

    Parameters
    ----------
    module : str
        As in an import statement: "pyvista", "matplotlib.figure".
    purpose : str
        What needs it; the message begins with these words.

    Raises
    ------
    ImportError
        If it cannot be loaded; the message says how to install it.
    """
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        msg = (
            f"{purpose} needs {NAMES.get(package, package)}, which cannot be loaded ({error}); "
            f"install it with: pip install 'dt3d[{EXTRAS.get(package, 'formats')}]'"
        )
        raise ImportError(msg) from error

"""Exact Delaunay triangulations in space and in the plane, in place of `scipy.spatial.Delaunay`.

`help(dt3d.Delaunay)` has a table of which call runs which engine.

>>> import numpy as np, dt3d
>>> tri = dt3d.Delaunay(np.random.default_rng(0).random((100, 3)))
>>> tri.simplices.shape[1], tri.simplices.dtype
(4, dtype('int32'))
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._errors import (
        DegenerateInputError,
        InconsistencyError,
        InconsistencyWarning,
        InternalError,
        QuadraticSearchWarning,
    )
    from ._references import references
    from ._stats import InsertionStatistics, Progress, Statistics
    from ._topology import OUTSIDE
    from .delaunay import Delaunay
    from .subset import Subset
    from .voronoi import Voronoi

__version__ = "0.1.0"

__all__ = [
    "OUTSIDE",
    "DegenerateInputError",
    "Delaunay",
    "InconsistencyError",
    "InconsistencyWarning",
    "InsertionStatistics",
    "InternalError",
    "Progress",
    "QuadraticSearchWarning",
    "Statistics",
    "Subset",
    "Voronoi",
    "__version__",
    "references",
]

# modules that are loaded as attributes: ``import dt3d; dt3d.interpolate``
_SUBMODULES = ("files", "interpolate", "jax", "predicates", "pyvista", "threaded2d", "verification")

_MODULES = {
    "OUTSIDE": "_topology",
    "Delaunay": "delaunay",
    "Subset": "subset",
    "Voronoi": "voronoi",
    "references": "_references",
    **dict.fromkeys(["InsertionStatistics", "Progress", "Statistics"], "_stats"),
    **dict.fromkeys([name for name in __all__ if name.endswith(("Error", "Warning"))], "_errors"),
}


def __getattr__(name: str) -> object:
    """Load a public name when it is first used.

    Libraries take their time to load, and the command line has to answer Ctrl-C before that.
    """
    if name in _SUBMODULES:
        return import_module(f"{__name__}.{name}")
    if name not in _MODULES:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_SUBMODULES})

"""dt3d: Delaunay triangulations in parallel, and how they come about.

>>> import numpy as np, dt3d
>>> tri = dt3d.Delaunay(np.random.default_rng(0).random((100, 3)))
>>> tri.simplices.shape[1], tri.simplices.dtype
(4, dtype('int32'))
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._errors import (
        DegenerateInputError,
        InconsistencyError,
        InconsistencyWarning,
        InternalError,
        QuadraticSearchWarning,
    )
    from ._stats import InsertionStatistics, Progress, Statistics
    from ._topology import OUTSIDE
    from .delaunay import Delaunay
    from .subset import Subset

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
    "__version__",
]

_MODULES = {
    "OUTSIDE": "_topology",
    "Delaunay": "delaunay",
    "Subset": "subset",
    **dict.fromkeys(["InsertionStatistics", "Progress", "Statistics"], "_stats"),
    **dict.fromkeys([name for name in __all__ if name.endswith(("Error", "Warning"))], "_errors"),
}


def __getattr__(name: str) -> Any:
    """A public name, loaded when it is first used: JAX takes a second, in which the command has to be there
    for Ctrl-C already."""
    if name not in _MODULES:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

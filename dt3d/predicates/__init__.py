"""Exact geometric predicates: signs that are right for all inputs.

`orient3d` and `in_sphere` take arrays and check them. What algorithms are written with has its own modules:

* compiled by numba, by rows of an array: `filtered`, its exact stage `exact` with the arithmetic of
  `expansions`, and `perturbed`, where ties are decided,
* in JAX, for one set of points inside mapped code: `elementwise`, with the arithmetic of `integers`.

What is imported from here loads when it is first used, so that the JAX forms do not load numba, nor importing
dt3d either.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .arrays import in_range, in_sphere, orient3d
    from .expansions import EXPONENTS, work_array

__all__ = ["EXPONENTS", "in_range", "in_sphere", "orient3d", "work_array"]

_HOME = {
    "EXPONENTS": "expansions",
    "in_range": "arrays",
    "in_sphere": "arrays",
    "orient3d": "arrays",
    "work_array": "expansions",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    return getattr(import_module(f".{_HOME[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])

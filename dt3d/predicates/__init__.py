"""Exact geometric predicates: signs that are right for all inputs.

`orient2d`, `orient3d`, `in_circle` and `in_sphere` take arrays and check them. What algorithms are written
with has its own modules:

* compiled by numba, for rows of an array: `filtered` and `filtered2d`, with what they leave open in
  `adaptive`, `adaptive2d` and `exact`; `perturbed` and `perturbed2d`, where ties are decided. They compute
  in a `work_array` that was made for the points, and fast if those are `scaled`.
* in JAX, for one set of points inside mapped code: `elementwise`, with the arithmetic of `integers`.

What is imported from here loads when it is first used, so that the JAX forms do not load numba, nor does
importing dt3d.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .arrays import in_circle, in_sphere, orient2d, orient3d
    from .work import scaled, work_array

__all__ = ["in_circle", "in_sphere", "orient2d", "orient3d", "scaled", "work_array"]

_HOME = dict.fromkeys(__all__, "arrays") | {"scaled": "work", "work_array": "work"}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    return getattr(import_module(f".{_HOME[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])

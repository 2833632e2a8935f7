"""Exact geometric predicates: signs that are right for all inputs.

`orient2d`, `orient3d`, `in_circle` and `in_sphere` take arrays and check them. What algorithms are written
with has its own modules:

* compiled by numba, for rows of an array: `plane` and `space`, with a workspace (`work_array`) that was made
  for the points; fast if those are `scaled`.
* in JAX, for one set of points inside mapped code: `traced.one_case`, with the arithmetic of `traced.digits`.

What is imported from here loads when it is first used, so that the JAX forms do not load numba, nor does
importing dt3d. The method and all files are in README.md beside this file.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .arrays import in_circle, in_sphere, orient2d, orient3d
    from .workspace import scaled, work_array

__all__ = ["in_circle", "in_sphere", "orient2d", "orient3d", "scaled", "work_array"]

_HOME = dict.fromkeys(__all__, "arrays") | {"scaled": "workspace", "work_array": "workspace"}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    return getattr(import_module(f".{_HOME[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])

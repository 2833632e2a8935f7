"""Names and forms of the last release: they work in this one, and say what to write instead."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import wraps
from typing import TypeVar, cast

F = TypeVar("F", bound=Callable[..., object])

# parameters are named as in the formula of the operation
KEYWORDS = {"record": "v", "first": "v", "second": "w"}

# names of `scanvec`, and what they are called now
NAMES = {"Hypercube": "HYPERCUBE", "Mesh2D": "MESH2D", "select": "where"}


def warn(old: str, new: str) -> None:
    """A DeprecationWarning at the caller's caller: ``old`` is to become ``new``."""
    warnings.warn(f"scanvec: {old} will go; use {new}", DeprecationWarning, stacklevel=3)


def old_keywords(function: F) -> F:
    """A function that also takes its vectors by the keywords of the last release."""

    @wraps(function)
    def run(*args: object, **options: object) -> object:
        for old in options.keys() & KEYWORDS.keys():
            warn(f"{function.__name__}({old}=...)", f"{KEYWORDS[old]}=...")
            options[KEYWORDS[old]] = options.pop(old)
        return function(*args, **options)

    return cast(F, run)


def into_by_position(function: F) -> F:
    """A ``send`` or a method that also takes ``into`` without its keyword, after the operator."""

    @wraps(function)
    def run(*args: object, **options: object) -> object:
        if "into" not in options:
            *args, options["into"] = args  # type: ignore[assignment]
            warn("send(v, index, op, into)", "send(v, index, op, into=into)")
        return function(*args, **options)

    return cast(F, run)


def zero_otherwise(function: F) -> F:
    """A ``get`` or a method that also takes a context without ``otherwise``, which is zero then."""

    @wraps(function)
    def run(*args: object, **options: object) -> object:
        if options.get("where") is not None and "otherwise" not in options:
            warn("get under a context without `otherwise`", "otherwise=0")
            options["otherwise"] = 0
        return function(*args, **options)

    return cast(F, run)


def writes_as(scatter: Callable[..., object]) -> Callable[[F], F]:
    """For ``permute``, which also takes ``into`` and a context, as ``scatter`` does now."""

    def decorate(function: F) -> F:
        @wraps(function)
        def run(*args: object, **options: object) -> object:
            if "into" not in options:
                return function(*args, **options)
            warn("permute(v, index, into=...)", "scatter(v, index, into=...)")
            return scatter(*args, **options)

        return cast(F, run)

    return decorate

"""Options that some methods have and others have not: the paper's own way, and what was changed of it."""

from __future__ import annotations

from typing import Literal, TypedDict, get_args

from .._options import is_count

PlanePreset = Literal["kohout2004"]
Parts = Literal["shared", "fixed"]
Queued = Literal["leaf", "parent"]
Tested = Literal["outer", "all"]

MOST_INTERLEAVED = 64

# what goes with which methods, and the value that any method has; the others go with all
METHODS_OF: dict[str, tuple[tuple[str, ...], object]] = {
    "interleave": (("sequential", "batch", "circumcircle"), 1),
    "queued": (("batch",), "leaf"),
    "helping": (("batch",), False),
    "tested": (("circumcircle",), "outer"),
    "head_start": (("circumcircle",), False),
}


class PlaneOptions(TypedDict, total=False):
    """Keywords of `dt3d.threaded2d.Delaunay`; None is as good as leaving one out."""

    queue_length: int | None
    preset: PlanePreset | None
    interleave: int | None
    parts: Parts | None
    queued: Queued | None
    tested: Tested | None
    head_start: bool | None
    helping: bool | None


# The methods as published: points are located one at a time (section 3.2), by threads with fixed parts (4.5);
# what is queued are parents of leaves (Algorithm 2); all triangles that a flip changes are tested (3.4).
KOHOUT2004: PlaneOptions = {
    "interleave": 1,
    "parts": "fixed",
    "queued": "parent",
    "tested": "all",
    "head_start": False,
    "helping": False,
}


def check_values(options: PlaneOptions, method: str, location: str) -> None:
    """Whether the options are what they may be, and go with the method and the location.

    Raises
    ------
    ValueError
        If not; the message says what came.
    """
    given = {name: value for name, value in options.items() if value is not None}
    for name, kind in (("preset", PlanePreset), ("parts", Parts), ("queued", Queued), ("tested", Tested)):
        if name in given and given[name] not in get_args(kind):
            msg = f"{name} must be {' or '.join(map(repr, get_args(kind)))}, got {given[name]!r}"
            raise ValueError(msg)
    for name in ("head_start", "helping"):
        if name in given and not isinstance(given[name], bool):
            msg = f"{name} must be True or False, got {given[name]!r}"
            raise ValueError(msg)
    for name, least in (("queue_length", 2), ("interleave", 1)):
        if name in given and not is_count(given[name], least):
            msg = f"{name} must be an integer of at least {least}, got {given[name]!r}"
            raise ValueError(msg)
    searches = options.get("interleave") or 1
    if searches > MOST_INTERLEAVED:
        msg = f"interleave must be at most {MOST_INTERLEAVED} searches per thread, got {searches}"
        raise ValueError(msg)
    for name, (methods, anyway) in METHODS_OF.items():
        if method not in methods and given.get(name, anyway) != anyway:
            msg = f"{name}={given[name]!r} goes with method={' or '.join(map(repr, methods))}, got {method!r}"
            raise ValueError(msg)
    if location == "walk":
        if method == "sequential" and searches > 1:
            msg = f"interleave={searches} goes with location='dag' for method='sequential', got 'walk'"
            raise ValueError(msg)
        if given.get("queued") == "parent":
            msg = "queued='parent' is a node of the history; it goes with location='dag', got 'walk'"
            raise ValueError(msg)


def with_preset(options: PlaneOptions) -> PlaneOptions:
    """The options, and what a preset says of those that are not given."""
    given: PlaneOptions = {}
    given.update(KOHOUT2004 if options.get("preset") else {})
    for name, value in options.items():
        if value is not None:
            given[name] = value  # type: ignore[literal-required]
    return given

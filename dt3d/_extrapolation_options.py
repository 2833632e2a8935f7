"""The options of `dt3d.Delaunay` that only extrapolation has: the paper's constants, and its preset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypedDict, get_args

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .extrapolation import SearchOptions

Preset = Literal["teng1993"]
Search = Literal["caps", "boxes"]
Cells = Literal["auto", "uniform"]


class ExtrapolationOptions(TypedDict, total=False):
    """Keywords of `dt3d.Delaunay`; None is as good as leaving one out."""

    dtype: npt.DTypeLike | None
    preset: Preset | None
    search: Search | None
    cells: Cells | None
    sites_per_cell: int | None
    sites_per_warrant: int | None
    preset_limit: int | None
    eta: float | None


def chosen_preset(options: ExtrapolationOptions) -> Preset | None:
    """The preset that is asked for.

    Raises
    ------
    ValueError
        If there is no such preset.
    """
    preset = options.get("preset")
    if preset is not None and preset not in get_args(Preset):
        msg = f"preset must be 'teng1993' or None, got {preset!r}"
        raise ValueError(msg)
    return preset


def check_without_extrapolation(options: ExtrapolationOptions, method: str) -> None:
    """Raise a ValueError if there is an option that only extrapolation has; dtype is checked elsewhere."""
    for name, value in options.items():
        if value is not None and name in ExtrapolationOptions.__annotations__ and name != "dtype":
            msg = f"{name}={value!r} goes with method='extrapolation', or machine=..., got method={method!r}"
            raise ValueError(msg)


def search_options(options: ExtrapolationOptions, *, exact: bool) -> SearchOptions:
    """How extrapolation searches.

    Raises
    ------
    ValueError
        If a value is out of range, or does not go with exact decisions.
    """
    from .extrapolation import PAPER_SEARCH, SearchOptions  # and with it JAX

    given = {name: value for name, value in options.items() if value is not None}
    paper = chosen_preset(options) is not None
    search = options.get("search") or ("boxes" if paper else "caps")
    cells = options.get("cells") or ("uniform" if paper or search == "boxes" else "auto")
    for name, word, kind in (("search", search, Search), ("cells", cells, Cells)):
        if word not in get_args(kind):
            msg = f"{name} must be {' or '.join(map(repr, get_args(kind)))}, got {word!r}"
            raise ValueError(msg)
    if exact:
        for name in ("eta", "search"):
            if name in given and given[name] != "caps":
                msg = f"{name}={given[name]!r} goes with robustness='perturb'; exact sites are not moved"
                raise ValueError(msg)
    if search == "boxes" and cells != "uniform":
        msg = f"search='boxes' opens boxes of cells; it goes with cells='uniform', got {cells!r}"
        raise ValueError(msg)
    limit = PAPER_SEARCH.preset_limit if search == "boxes" else SearchOptions.preset_limit
    per_cell = _count(options, "sites_per_cell", SearchOptions.sites_per_cell)
    return SearchOptions(
        whole_boxes=search == "boxes",
        uniform_cells=cells == "uniform",
        sites_per_cell=per_cell,
        sites_per_warrant=_count(options, "sites_per_warrant", per_cell),
        preset_limit=_count(options, "preset_limit", limit),
        eta=_eta(options.get("eta")),
    )


def _count(options: ExtrapolationOptions, name: str, default: int) -> int:
    value = options.get(name)
    if value is None:
        return default
    if not isinstance(value, int | np.integer) or isinstance(value, bool) or value < 1:
        msg = f"{name} must be a positive integer, got {value!r}"
        raise ValueError(msg)
    return int(value)


def _eta(eta: object) -> float | None:
    if eta is None:
        return None
    if not isinstance(eta, int | float | np.number) or isinstance(eta, bool) or not 0 < eta < 1:
        msg = f"eta must be a number between 0 and 1, such as 2**-30, got {eta!r}"
        raise ValueError(msg)
    return float(eta)

"""Which options of the two public classes go together, and what the errors say."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
import numpy.typing as npt

from ._extrapolation_options import ExtrapolationOptions, check_without_extrapolation, chosen_preset
from ._input import check_seed, word_of

if TYPE_CHECKING:
    import scanvec as sv

    from ._stats import Progress

Method = Literal["auto", "insertion", "extrapolation"]
Robustness = Literal["exact", "perturb"]
PlaneMethod = Literal["auto", "sequential", "batch", "circumcircle", "pessimistic", "optimistic"]
Order = Literal["brio", "random"]
Location = Literal["dag", "walk"]
Subdivision = Literal["random", "x-slabs", "distance", "curve"]

MOST_THREADS_IN_PLANE = 64


class SpaceOptions(ExtrapolationOptions, total=False):
    """Keywords of `dt3d.Delaunay` that points in space have; None is as good as leaving one out."""

    robustness: Robustness
    machine: sv.Machine | None
    callback: Callable[[Progress], object] | None


def check_space_options(
    method: str, threads: int | None, options: SpaceOptions
) -> tuple[str, np.dtype, bool]:
    """The method that `dt3d.Delaunay` has to take, the working precision, and whether decisions are exact.

    Raises
    ------
    ValueError
        If an option is unknown, or does not go with the others.
    """
    working = _working_precision(options.get("dtype"))
    callback, machine = options.get("callback"), options.get("machine")
    robustness = "perturb" if chosen_preset(options) is not None else options.get("robustness") or "exact"
    if callback is not None and not callable(callback):
        msg = f"callback must be callable, got {callback!r}"
        raise ValueError(msg)
    *first, last = map(repr, get_args(Method))
    if method not in get_args(Method):
        msg = f"method must be {', '.join(first)} or {last}, got {method!r}"
        if method in get_args(PlaneMethod):
            msg += "; that is one of dt3d.threaded2d.Delaunay"
        raise ValueError(msg)
    if robustness not in get_args(Robustness):
        msg = f"robustness must be 'exact' or 'perturb', got {robustness!r}"
        raise ValueError(msg)
    if machine is not None and not _is_machine(machine):
        msg = f"machine must be a scanvec machine, such as scanvec.Simulated(processors=32), got {machine!r}"
        raise ValueError(msg)
    if working == np.float32 and robustness == "exact":
        msg = "dtype='float32' cannot hold the sites exactly; it goes with robustness='perturb'"
        raise ValueError(msg)
    only_extrapolation = machine is not None or robustness == "perturb"
    if method == "insertion" and only_extrapolation:
        msg = (
            "method='insertion' is exact, and runs on this CPU; machine and robustness='perturb' go with "
            "method='extrapolation'"
        )
        raise ValueError(msg)
    if method == "auto":
        method = "extrapolation" if only_extrapolation else "insertion"
    _check_threads(threads, method)
    if method != "extrapolation":
        check_without_extrapolation(options, method)
    return method, working, robustness == "exact"


def check_of_plane(method: str, options: SpaceOptions) -> None:
    """Raise a ValueError if an option that is given does not go with points in the plane."""
    given = {"method": None if method in ("auto", "insertion") else method, **options}
    if given.get("robustness") == "exact":
        del given["robustness"]
    for name, value in given.items():
        if value is not None:
            msg = (
                f"{name}={value!r} goes with points in space, and these have two coordinates; leave it out. "
                f"dt3d.threaded2d.Delaunay has the options of the plane"
            )
            raise ValueError(msg)


def _is_machine(machine: object) -> bool:
    from scanvec import Machine  # and with it JAX, which the plane does not need

    return isinstance(machine, Machine)


def _check_threads(threads: int | None, method: str) -> None:
    if threads is None:
        return
    if not is_count(threads, 1):
        msg = f"threads must be a positive integer, or None for as many as there are cores, got {threads!r}"
        raise ValueError(msg)
    if method != "insertion":
        msg = f"threads={threads} goes with method='insertion'; what extrapolation runs on is its machine"
        raise ValueError(msg)


def _working_precision(dtype: npt.DTypeLike | None) -> np.dtype:
    try:
        working = np.dtype(np.float64 if dtype is None else dtype)
    except TypeError:
        working = None
    if working is None or working not in (np.float32, np.float64):
        msg = f"dtype must be float64 or float32, got {dtype!r}"
        raise ValueError(msg)
    return working


def check_plane_options(
    method: str,
    threads: int | None,
    order: str,
    location: str,
    subdivision: str,
    seed: int,
) -> int:
    """The seed as compiled code takes it, if `dt3d.threaded2d.Delaunay` can take the options together.

    Raises
    ------
    ValueError
        If an option is unknown, or does not go with the others.
    """
    for name, value, kind in (
        ("method", method, PlaneMethod),
        ("order", order, Order),
        ("location", location, Location),
        ("subdivision", subdivision, Subdivision),
    ):
        if value not in get_args(kind):
            msg = f"{name} must be one of {', '.join(map(repr, get_args(kind)))}, got {value!r}"
            raise ValueError(msg)
    if threads is not None and not is_count(threads, 1):
        msg = f"threads must be an integer of at least 1, got {threads!r}"
        raise ValueError(msg)
    word = word_of(check_seed(seed))
    if threads is not None and threads > MOST_THREADS_IN_PLANE:
        msg = f"threads must be at most {MOST_THREADS_IN_PLANE}, got {threads}"
        raise ValueError(msg)
    if method == "sequential" and threads not in (None, 1):
        msg = f"method='sequential' has one thread, got threads={threads}; choose another method"
        raise ValueError(msg)
    if method == "batch" and threads == 1:
        msg = "method='batch' needs a searching and a specialised thread, got threads=1"
        raise ValueError(msg)
    if subdivision == "curve" and order == "random":
        msg = "subdivision='curve' goes with order='brio', got order='random'"
        raise ValueError(msg)
    return word


def check_names(options: Mapping[str, object], known: Collection[str], of: str) -> None:
    """Raise TypeError for a keyword that is not known, and say of which function."""
    for name in options:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            meant = f"; did you mean {near[0]!r}?" if near else f"; there are also {', '.join(known)}"
            msg = f"{of} has no option {name!r}{meant}"
            raise TypeError(msg)


def is_count(number: object, least: int) -> bool:
    """Whether it is an integer, and no bool, of at least so much."""
    return isinstance(number, int | np.integer) and not isinstance(number, bool) and bool(number >= least)

"""Why a first call takes long: what numba compiles is said once, with the seconds that it takes.

numba keeps what it compiles on disk, so that a machine hears of each part once. It goes to the logger "dt3d"
as a warning, which is printed to stderr where nobody has configured logging, as JAX does for what a user
should know. ``logging.getLogger("dt3d").setLevel("ERROR")`` silences it.
"""

from __future__ import annotations

import functools
import logging
import threading
from dataclasses import dataclass

from .kept import CURE, Kept

ONCE = "once on this machine (dt3d warmup compiles all parts)"
NOT_KEPT = (
    "in every process, for neither the package's folder nor the user's cache folder can be written; " + CURE
)


@dataclass(frozen=True)
class Part:
    """What is compiled together.

    Attributes
    ----------
    name : str
        For people.
    modules : tuple of str
        Beginnings of the names of its modules, below ``dt3d``; the longest that fits decides.
    seconds : int
        How long it takes on two cores, as measured.
    """

    name: str
    modules: tuple[str, ...]
    seconds: int


PARTS = (
    Part("the order of insertion", ("ordering",), 3),
    Part("the exact stages of predicates", ("predicates",), 7),
    Part("insertion in space", ("insertion",), 6),
    Part("insertion in the plane", ("threaded2d",), 6),
    Part("point location", ("location", "_star", "threaded2d.location"), 3),
    Part("proofs", ("verification", "threaded2d.verification"), 3),
    Part("sizes and shapes", ("geometry", "alpha", "_vertices"), 4),
    Part("Voronoi cells", ("voronoi",), 3),
    Part("interpolation", ("interpolate",), 10),
    Part("extrapolation", ("extrapolation",), 2),
)
OTHER = Part("a part of dt3d", ("",), 2)


def part_of(module: str) -> Part | None:
    """The part of a module by its name; None for modules that are not dt3d's."""
    package, _, below = module.partition(".")
    if package != "dt3d":
        return None
    fits = [(len(start), part) for part in PARTS for start in part.modules if below.startswith(start)]
    return max(fits, key=lambda fit: fit[0])[1] if fits else OTHER


def announce(module: str) -> None:
    """Say that a module's part is being compiled, unless this process has said so."""
    part = part_of(module)
    if part is None or part in _said():
        return
    _said().add(part)
    kept = ONCE if Kept.anywhere else NOT_KEPT
    logging.getLogger("dt3d").warning("compiling %s, some %d s, %s", part.name, part.seconds, kept)


@functools.cache
def _said() -> set[Part]:
    return set()


@functools.cache
def announce_compilation() -> None:
    """Announce, from now on, the parts of dt3d that numba has to compile.

    What numba has on disk is not announced.
    """
    from numba.core import event

    at_hand = threading.local()  # functions that this thread is about to compile, one for the other

    class Announcer(event.Listener):
        def on_start(self, event: event.Event) -> None:
            at_hand.count = getattr(at_hand, "count", 0) + 1
            if at_hand.count == 1:
                announce(event.data["dispatcher"].py_func.__module__)

        def on_end(self, event: event.Event) -> None:
            at_hand.count = max(0, getattr(at_hand, "count", 0) - 1)

    event.register("numba:compile", Announcer())

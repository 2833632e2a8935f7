"""Two ways to the same result, timed in turn, so that what disturbs one disturbs the other."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True)
class Pair:
    """What was measured.

    Attributes
    ----------
    task : str
        What both did: "linear interpolation in space".
    size : str
        Of what: "10^6 queries, 10^5 sites".
    other : str
        The library that is compared: "scipy".
    ours, theirs : tuple of float
        Seconds of each round.
    note : str
        How far the results agree, in words.
    """

    task: str
    size: str
    other: str
    ours: tuple[float, ...]
    theirs: tuple[float, ...]
    note: str = ""

    @property
    def ratio(self) -> float:
        """How many times as long the other took, by medians."""
        return median(self.theirs) / median(self.ours)


def in_turn(
    ours: Callable[[], object], theirs: Callable[[], object], rounds: int
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Seconds of each round of both, after one call of ours that is not counted: it may compile."""
    ours()
    seconds: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for call, taken in zip((ours, theirs), seconds, strict=True):
            begun = time.perf_counter()
            call()
            taken.append(time.perf_counter() - begun)
    return tuple(seconds[0]), tuple(seconds[1])

"""Speed-ups over the sequential method: in virtual time, and of real threads with their spread."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..._numba.cores import available_cores
from ...threaded2d.configuration import Options, configured, queue_for
from ...threaded2d.correction import correct
from ...threaded2d.driver import triangulate
from ...threaded2d.mesh import ROOTS
from ...threaded2d.options import PlaneOptions
from ...threaded2d.virtual_time.costs import prepared
from ...threaded2d.virtual_time.scheduler import Simulation, simulate
from .costs import CostTable
from .report import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PAPER: PlaneOptions = {"preset": "kohout2004"}
OURS: PlaneOptions = {}

LEAST_SITES = 100_000  # triangulated by each method before a measured speed-up counts

VIRTUAL = (
    "Virtual: on simulated elements, without caches and memory bandwidth, which make the paper's values "
    "exceed the number of elements; by {source}, so that the same file gives the same numbers."
)
MEASURED = (
    "Measured: this machine, {processors} processors, medians of {repeats} runs or more in turn with the "
    "sequential method, insertion and correction; beside them the quartiles of the ratios."
)

SEARCHING = 3  # to one specialised thread, with the batch method


def threads_for(method: str, elements: int, searching: int = SEARCHING) -> int:
    """All threads of a method on so many processing elements."""
    return searching + 1 if method == "batch" else elements


class Spread(NamedTuple):
    """The median of several ratios, and their quartiles."""

    median: float
    low: float
    high: float

    @property
    def quartiles(self) -> str:
        """As text."""
        return f"{self.low:.2f}-{self.high:.2f}"


def options_of(
    n: int, method: str, threads: int, way: PlaneOptions, *, subdivision: str = "random", seed: int = 0
) -> Options:
    """What is run for n points, in random order, with the queue that suits them."""
    own: PlaneOptions = {"queue_length": queue_for(n)}
    own.update(way)
    return configured(
        n, method=method, threads=threads, order="random", subdivision=subdivision, seed=seed, **own
    )


class SpeedupSet:
    """A set of points, with its costs and its sequential time.

    Parameters
    ----------
    name : str
        Of the distribution.
    points : float64 (n, 2)
    costs : CostTable
    """

    def __init__(self, name: str, points: np.ndarray, costs: CostTable) -> None:
        self.name, self.points, self.table = name, points, costs
        self.sequential = options_of(len(points), "sequential", 1, OURS)
        self.alone = self.simulated(self.sequential, 1).seconds

    def simulated(self, options: Options, elements: int) -> Simulation:
        """A run in virtual time. Searches that are interleaved wait for memory together."""
        found = self.table.of(self.name, len(self.points), options.searches)
        return simulate(self.points, options, elements, found.costs)

    def virtual(
        self, method: str, threads: int, elements: int, way: PlaneOptions = PAPER, subdivision: str = "random"
    ) -> float:
        """The speed-up in virtual time over the sequential method, one site at a time."""
        options = options_of(len(self.points), method, threads, way, subdivision=subdivision)
        return self.alone / self.simulated(options, elements).seconds

    def measured(
        self, method: str, threads: int, repeats: int, way: PlaneOptions = PAPER, base: PlaneOptions = OURS
    ) -> Spread:
        """The speed-up of real threads here over the sequential method with the options ``base``."""
        n = len(self.points)
        both = options_of(n, "sequential", 1, base), options_of(n, method, threads, way)
        for o in both:
            _compiled(self.points, o)
        # small sets take less time than a thread takes to start, now and then
        rounds = max(repeats, LEAST_SITES // n)
        times = np.array([[_seconds(self.points, o) for o in both] for _ in range(rounds)])
        alone, together = np.median(times, axis=0)
        low, high = np.quantile(times[:, 0] / times[:, 1], [0.25, 0.75])
        return Spread(float(alone / together), float(low), float(high))

    def row(self, method: str, repeats: int, way: PlaneOptions = PAPER) -> Row:
        """Speed-ups on 2 and 4 simulated elements, and here."""
        here = self.measured(method, threads_for(method, available_cores()), repeats, way)
        return {
            "virtual 2": self.virtual(method, threads_for(method, 2), 2, way),
            "virtual 4": self.virtual(method, threads_for(method, 4), 4, way),
            "measured": here.median,
            "quartiles": here.quartiles,
        }


def _compiled(points: np.ndarray, options: Options) -> None:
    """Have everything compiled that a run may need, before the clock runs."""
    few = points[: min(500, len(points))]
    triangulate(few, options)
    store, _ = prepared(few, options)
    correct(store, np.arange(ROOTS, dtype=np.int32))


def _seconds(points: np.ndarray, options: Options) -> float:
    seconds = triangulate(points, options).stats.seconds
    return seconds["insertion"] + seconds["correction"]


def note_of(source: str, repeats: int | None = None) -> str:
    """What the numbers of a table are."""
    virtual = VIRTUAL.format(source=source)
    return virtual if repeats is None else f"{virtual} {measured_note(repeats)}"


def measured_note(repeats: int) -> str:
    """What measured numbers are."""
    return MEASURED.format(processors=available_cores(), repeats=repeats)


def lines_over(rows: list[Row], x: str, columns: dict[str, str], ylabel: str) -> Callable[[Axes], None]:
    """A picture of columns over the column ``x``, each in its style of matplotlib."""

    def draw(axes: Axes) -> None:
        for column, style in columns.items():
            known = [row for row in rows if row.get(column) is not None]
            if known:
                axes.plot([row[x] for row in known], [row[column] for row in known], style, label=column)
        axes.set(xlabel=x, ylabel=ylabel, ylim=(0, None))
        if x == "points" and len(rows) > 1:
            axes.set_xscale("log")
        if len(columns) > 5:
            axes.figure.legend(loc="outside right upper")
        else:
            axes.legend()

    return draw

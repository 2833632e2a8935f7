"""The costs that virtual time counts with: a file that ships, one that is given, or measured anew.

Costs are of this or that computer, and a measurement differs from the next. With the same file two runs of an
experiment print the same table. ``dt3d experiment kohout-costs`` writes such a file.
"""

from __future__ import annotations

import csv
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...samples import crater_lake
from ...threaded2d.virtual_time.costs import Costs, measure
from . import sets
from .report import Row, publish

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

SHIPPED = Path(__file__).with_name("costs.csv")  # measured once, on two cores of a cloud machine
SHIPPED_NAME, MEASURE = "shipped", "measure"

TIMES = tuple(f"{name}_ns" for name in Costs._fields)
HEADER = ("set", "points", "interleave", *TIMES, "sort_ns", "select_ns")


class Measured(NamedTuple):
    """What was measured of a set of points.

    Attributes
    ----------
    name, points, interleave
        The distribution, how many points, and how many searches were interleaved.
    costs : Costs
        Seconds of the operations.
    sort, select : float
        Seconds per point to sort by a coordinate, and to find the median of one.
    """

    name: str
    points: int
    interleave: int
    costs: Costs
    sort: float
    select: float


class CostTable:
    """Costs by distribution, number of points, and searches that are interleaved.

    Parameters
    ----------
    rows : sequence of Measured
    source : str
        Where they are from, to be printed.
    """

    def __init__(self, rows: Sequence[Measured], source: str) -> None:
        self.rows, self.source = list(rows), source

    def of(self, name: str, points: int, interleave: int = 1) -> Measured:
        """Those of a set.

        Between two sizes costs go by the logarithm of the number of points; beyond the sizes that were
        measured they are those of the nearest. A distribution that was not measured has those of uniform
        points, and numbers of searches that were not measured those of the nearest.

        Raises
        ------
        ValueError
            If there are neither costs of this distribution nor of uniform points.
        """
        known = {row.name for row in self.rows}
        chosen = name if name in known else "uniform"
        rows = [row for row in self.rows if row.name == chosen]
        if not rows:
            msg = (
                f"there are no costs of {name!r} or 'uniform' points in {self.source}; it has {sorted(known)}"
            )
            raise ValueError(msg)
        nearest = min({row.interleave for row in rows}, key=lambda k: abs(np.log(k / interleave)))
        rows = sorted((row for row in rows if row.interleave == nearest), key=lambda row: row.points)
        at = np.log([row.points for row in rows])

        def between(values: Sequence[float]) -> float:
            return float(np.interp(np.log(points), at, values))

        costs = Costs(*(between(values) for values in zip(*(row.costs for row in rows), strict=True)))
        sort, select = between([row.sort for row in rows]), between([row.select for row in rows])
        return Measured(name, points, interleave, costs, sort, select)


def read(path: Path) -> CostTable:
    """The costs in a file as `write` leaves it.

    Raises
    ------
    ValueError
        If it is not such a file; says which line and what was expected.
    """
    with path.open(newline="", encoding="utf-8") as file:
        lines = csv.DictReader(file)
        if tuple(lines.fieldnames or ()) != HEADER:
            msg = (
                f"{path} has the columns {', '.join(lines.fieldnames or ()) or '(none)'}; "
                f"a file of costs has {', '.join(HEADER)}; dt3d experiment kohout-costs writes one"
            )
            raise ValueError(msg)
        rows = []
        for number, line in enumerate(lines, 2):
            try:
                times = [1e-9 * float(line[name]) for name in (*TIMES, "sort_ns", "select_ns")]
                points, interleave = int(line["points"]), int(line["interleave"])
            except (TypeError, ValueError) as error:
                msg = f"{path}, line {number}: expected a name and numbers, got {list(line.values())}"
                raise ValueError(msg) from error
            if points < 1 or interleave < 1 or not all(0 <= t < 1 for t in times):
                msg = f"{path}, line {number}: counts must be positive, and costs 0 to 10^9 ns"
                raise ValueError(msg)
            rows.append(Measured(line["set"], points, interleave, Costs(*times[:-2]), times[-2], times[-1]))
    return CostTable(rows, str(path))


def rows_of(measured: Sequence[Measured]) -> list[Row]:
    """What a file of costs has, in nanoseconds."""
    out: list[Row] = []
    for m in measured:
        times = [1e9 * t for t in (*m.costs, m.sort, m.select)]
        values = (m.name, m.points, m.interleave, *(float(f"{t:.4g}") for t in times))
        out.append(dict(zip(HEADER, values, strict=True)))
    return out


def measured_costs(name: str, points: np.ndarray, interleave: int = 1, repeats: int = 3) -> Measured:
    """The costs of these points, float64 (n, 2), in random order, on this computer."""
    half, sort, select = len(points) // 2, [], []
    for _ in range(repeats):
        begun = time.perf_counter()
        np.argsort(points[:, 0], kind="stable")
        sorted_at = time.perf_counter()
        np.argpartition(points[:, 0], half)
        sort.append((sorted_at - begun) / len(points))
        select.append((time.perf_counter() - sorted_at) / len(points))
    costs = measure(points, "random", repeats, interleave)
    return Measured(name, len(points), interleave, costs, float(np.median(sort)), float(np.median(select)))


def crater_sites(n: int, seed: int = 0) -> np.ndarray:
    """n points of Crater Lake at random, with their heights, float64 (n, 3); all if there are no more."""
    sites = crater_lake()
    if n >= len(sites):
        return sites
    chosen: np.ndarray = sites[np.sort(np.random.default_rng(seed).permutation(len(sites))[:n])]
    return chosen


def points_of(name: str, n: int, seed: int = 0) -> np.ndarray:
    """n points of a distribution, or of the real set "crater", float64 (n, 2).

    Raises
    ------
    ValueError
        If there is no such distribution.
    """
    if name == "crater":
        return crater_sites(n, seed)[:, :2]
    if name not in sets.DISTRIBUTIONS:
        msg = f"there is no distribution {name!r}; there are {', '.join(sets.DISTRIBUTIONS)} and crater"
        raise ValueError(msg)
    return sets.DISTRIBUTIONS[name](n, seed)


def chosen_costs(option: str, needed: Sequence[tuple[str, int, int]] = ()) -> CostTable:
    """The costs that an option names: "shipped", "measure", or a file.

    ``needed`` are the sets, numbers of points and searches to measure.
    """
    if option == SHIPPED_NAME:
        table = read(SHIPPED)
        return CostTable(table.rows, "the costs that ship with dt3d")
    if option == MEASURE:
        found = [measured_costs(name, points_of(name, n), k) for name, n, k in dict.fromkeys(needed)]
        return CostTable(found, "costs measured now")
    path = Path(option)
    if not path.is_file():
        msg = f"costs must be '{SHIPPED_NAME}', '{MEASURE}' or a file of costs; there is no file {option!r}"
        raise ValueError(msg)
    return read(path)


def described(m: Measured) -> str:
    """Costs in one line, to be printed."""
    times = ", ".join(f"{name} {1e9 * t:,.0f}" for name, t in zip(Costs._fields, m.costs, strict=True))
    searches = "one search at a time" if m.interleave == 1 else f"{m.interleave} searches interleaved"
    return f"{m.name}, {m.points:,} points, {searches}: {times} ns"


def measure_costs(
    out: Path,
    console: Console,
    *,
    points: int | str = "1000,10000,100000",
    interleave: int | str = "1,8",
    repeats: int = 5,
) -> list[Row]:
    """Beyond the paper: what the operations of virtual time cost here, as a file for ``--costs``.

    Of the paper's distributions and of Crater Lake, in random order, by medians of sequential runs.
    """
    searches = [int(k) for k in str(interleave).split(",")]
    found = [
        measured_costs(name, points_of(name, n), k, repeats)
        for name in (*sets.DISTRIBUTIONS, "crater")
        for n in sets.sizes(points)
        for k in searches
    ]
    rows = rows_of(found)

    def draw(axes: Axes) -> None:
        for name in (*sets.DISTRIBUTIONS, "crater"):
            for k, style in zip(searches, ("o-", "s--", "^:", "v-."), strict=False):
                of_set = [row for row in rows if row["set"] == name and row["interleave"] == k]
                axes.plot(
                    [row["points"] for row in of_set],
                    [row["visit_ns"] for row in of_set],
                    style,
                    label=f"{name}, {k} at a time",
                )
        axes.set(xscale="log", xlabel="points", ylabel="visit of a node, ns", ylim=(0, None))
        axes.figure.legend(loc="outside right upper")

    note = "Queue, locks and waits are not measured, but of the usual size. Give the file by --costs."
    publish("kohout-costs", "Costs of virtual time", rows, out, console, draw, note)
    return rows

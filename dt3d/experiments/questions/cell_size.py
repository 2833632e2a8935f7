"""Are eight sites per cell the balance, and warrants of eight?

Teng et al. 1993, section 7, chose the cells "in a way such that the computation cost of the site search and
the overhead of managing the intermediate structures are balanced", which gave eight sites per cell. Small
cells cost requests, large ones sites that are searched in vain. Warrants have a balance of their own, as a
small one costs an allocation and in a large one processors wait for the longest. One run counts the loads of
all models and numbers of processors.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import scanvec as sv

from ..._stats import Statistics
from ...delaunay import Delaunay
from ...extrapolation.buckets import cube_of_cells
from .._output import new_table, panels, publish
from ..machines import MODELS
from ..paper import CM2_PROCESSORS, PROCESSORS
from ..runs import MAIN_LOOP, SEED, points_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

PAPER = 8  # sites per cell and per warrant
NODES = (PROCESSORS, 256, CM2_PROCESSORS)  # the paper's CM-5 at its least and largest, and its CM-2
SHOWN = ((sv.CM5, PROCESSORS), (sv.CM5, 256), (sv.CM2, CM2_PROCESSORS))


@dataclass(frozen=True)
class Run:
    """One run of the paper's method with cells and warrants of some sizes.

    Attributes
    ----------
    per_cell, per_warrant : int
        Sites, as asked for.
    really : float
        Sites per cell, as the cube has a whole number of cells along each axis.
    cells, searched : float
        Cells opened and sites searched per face expansion.
    ledgers : dict of int to scanvec.Ledger
        Of the main loop, by number of processors.
    """

    per_cell: int
    per_warrant: int
    really: float
    cells: float
    searched: float
    ledgers: dict[int, sv.Ledger] = field(repr=False)

    def seconds(self, model: sv.Model, processors: int) -> float:
        """The main loop's under a model."""
        return float(self.ledgers[processors].under(model).seconds)


def pairs(largest: int, apart: int) -> Iterator[tuple[int, int]]:
    """Sizes of cells and warrants, powers of two up to the largest: alike, or one of them the paper's.

    The latter differ by a factor of ``apart`` at most.
    """
    sizes = [2**k for k in range(1, largest.bit_length())]
    yield from ((s, s) for s in sizes)
    others = [s for s in sizes if s != PAPER and apart * s >= PAPER and s <= apart * PAPER]
    if PAPER in sizes:
        yield from ((PAPER, w) for w in others)
        yield from ((s, PAPER) for s in others)


def run(points: np.ndarray, per_cell: int, per_warrant: int, nodes: Sequence[int] = NODES) -> Run:
    """Triangulate points (n, 3) as the paper does, but for the sizes of cells and warrants."""
    # accesses are counted for this model, so that the ledger serves all
    machine = sv.Simulated(nodes[0], model=sv.EREW_PRAM, also=nodes[1:])
    tri = Delaunay(
        points,
        machine=machine,
        preset="teng1993",
        sites_per_cell=per_cell,
        sites_per_warrant=per_warrant,
    )
    s = tri.stats
    assert isinstance(s, Statistics)
    low, high = ([float(v) for v in extreme] for extreme in (points.min(axis=0), points.max(axis=0)))
    grid = cube_of_cells(low, high, len(points) / per_cell, np.float64)
    return Run(
        per_cell,
        per_warrant,
        len(points) / (int(grid.nx) * int(grid.ny) * int(grid.nz)),
        s.cells_opened / s.face_expansions,
        s.sites_searched / s.face_expansions,
        {p: ledger.of(*MAIN_LOOP) for p, ledger in machine.ledgers.items()},
    )


@dataclass(frozen=True)
class Balance:
    """What is best on one machine, beside the paper's choice."""

    model: str
    processors: int
    alike: Run  # the best of those whose warrants are as large as their cells
    alike_seconds: float
    best: Run  # of all
    best_seconds: float
    paper_seconds: float  # with the paper's sizes, or the nearest that were tried


def balances(runs: Sequence[Run]) -> list[Balance]:
    """The best sizes by model and processors."""
    alike = [r for r in runs if r.per_cell == r.per_warrant]
    paper = min(alike, key=lambda r: abs(r.per_cell - PAPER))
    out = []
    for model in MODELS:
        for p in runs[0].ledgers:
            one, best = (min(some, key=lambda r: r.seconds(model, p)) for some in (alike, runs))
            times = [r.seconds(model, p) for r in (one, best, paper)]
            out.append(Balance(model.name, p, one, times[0], best, times[1], times[2]))
    return out


def cell_size(
    out: Path,
    console: Console,
    *,
    sites: int = 1000,
    largest_cell: int = 32,
    apart: int = 2,
    seed: int = SEED,
) -> list[Run]:
    """Teng et al. 1993, section 7: are 8 sites per cell, and warrants of 8, the balance? By machine model.

    Predicted seconds of the main loop for one random set, cells and warrants of 2, 4, ... sites, alike or, if
    one is 8, by a factor of ``apart`` from each other. Writes ``cell-size.csv``, ``cell-size.png`` and
    ``cell-size.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    points, runs = points_of(f"rand.{sites}", seed), []
    with console.status("...") as status:
        for per_cell, per_warrant in pairs(largest_cell, apart):
            status.update(f"{per_cell} sites per cell, {per_warrant} per warrant ...")
            runs.append(run(points, per_cell, per_warrant))
    table = new_table(
        f"Seconds of the main loop for {sites} random sites, by sites per cell and per warrant",
        ("per cell", "per warrant"),
        ("really per cell", "cells/FE", "search/FE", *(f"{m.name}, {p:,}" for m, p in SHOWN)),
    )
    for r in runs:
        table.add_row(
            str(r.per_cell),
            str(r.per_warrant),
            f"{r.really:.1f}",
            f"{r.cells:.1f}",
            f"{r.searched:.1f}",
            *(f"{r.seconds(m, p):.2f}" for m, p in SHOWN),
        )
    table.show(console)
    found = balances(runs)
    _print(found, console)
    names = [f"{m.name}_{p}" for m in MODELS for p in NODES]
    header = ["per_cell", "per_warrant", "really_per_cell", "cells_per_expansion", "searched_per_expansion"]
    lines: list[list[object]] = []
    for r in runs:
        seconds = [r.seconds(m, p) for m in MODELS for p in NODES]
        lines.append([r.per_cell, r.per_warrant, r.really, r.cells, r.searched, *seconds])
    publish(console, out, "cell-size", [*header, *names], lines, _draw(runs))
    return runs


def _print(found: list[Balance], console: Console) -> None:
    table = new_table(
        "The best sizes by machine, and how much longer the paper's 8 and 8 take",
        ("machine",),
        ("processors", "best alike", "8 and 8: % longer", "best cell", "and warrant", "8 and 8: % longer "),
    )
    for b in found:
        table.add_row(
            b.model,
            f"{b.processors:,}",
            str(b.alike.per_cell),
            f"{_more(b.paper_seconds, b.alike_seconds):.1f}",
            str(b.best.per_cell),
            str(b.best.per_warrant),
            f"{_more(b.paper_seconds, b.best_seconds):.1f}",
        )
    table.show(console)
    (cm5,) = (b for b in found if (b.model, b.processors) == (sv.CM5.name, PROCESSORS))
    same = sum(b.alike.per_cell == PAPER for b in found)
    worst = max(found, key=lambda b: b.paper_seconds / b.best_seconds)
    console.print(
        f"On the paper's CM-5 of {PROCESSORS} nodes, {cm5.alike.per_cell} sites per cell and warrant are "
        f"best of sizes that are alike; the best pair is {cm5.best.per_cell} and {cm5.best.per_warrant}, "
        f"than which 8 and 8 take {_more(cm5.paper_seconds, cm5.best_seconds):.1f} % longer. Cells and "
        f"warrants of 8 are best among like sizes on {same} of {len(found)} machines here. Nowhere do 8 "
        f"and 8 take more than {_more(worst.paper_seconds, worst.best_seconds):.1f} % longer than the best "
        f"pair ({worst.model}, {worst.processors:,} processors: {worst.best.per_cell} and "
        f"{worst.best.per_warrant})."
    )
    console.print(
        "FE: face expansion. Of pairs that are not alike one is 8. Loads are exact, the models are rough; "
        "the CM-5's constants are fitted to runs with 8 and 8, the CM-2's loads are of double precision. It "
        "is one set, uniform, and the number of cells along an axis is whole, so that sizes per cell differ "
        "from what was asked for."
    )


def _more(seconds: float, best: float) -> float:
    """How much longer, in per cent."""
    return 100 * (seconds / best - 1)


def _draw(runs: list[Run]) -> Figure:
    figure, axes = panels(2, 4.5)
    alike = [r for r in runs if r.per_cell == r.per_warrant]
    for model, p in [*SHOWN, *((m, 256) for m in MODELS if m not in (sv.CM5, sv.CM2))]:
        seconds = np.array([r.seconds(model, p) for r in alike])
        name = f"{model.name}, {p:,}"
        axes[0].plot([r.per_cell for r in alike], seconds / seconds.min(), "o-", label=name)
    axes[0].set(xlabel="sites per cell and per warrant", ylabel="predicted time / least of the curve")
    axes[0].legend()
    kinds = {
        "cells and warrants": [(r.per_cell, r) for r in alike],
        "warrants; cells of 8": [(r.per_warrant, r) for r in runs if r.per_cell == PAPER],
        "cells; warrants of 8": [(r.per_cell, r) for r in runs if r.per_warrant == PAPER],
    }
    for name, of in kinds.items():
        of.sort(key=lambda x: x[0])
        axes[1].plot([x for x, _ in of], [r.seconds(*SHOWN[0]) for _, r in of], "o-", label=name)
    axes[1].set(xlabel="sites", ylabel=f"predicted seconds, CM-5 of {PROCESSORS} nodes")
    axes[1].legend()
    for ax in axes:
        ax.set_xscale("log", base=2)
        ax.set_xticks([r.per_cell for r in alike], [str(r.per_cell) for r in alike])
        ax.axvline(PAPER, color="0.8", zorder=0)
    return figure

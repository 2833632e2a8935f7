"""Table 1 of Teng et al. 1993: what the algorithm does on point sets from 20 to 16,000 sites."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import scanvec as sv

from .._stats import Statistics
from ..delaunay import Delaunay
from . import sets

if TYPE_CHECKING:
    from rich.console import Console

PROCESSORS = 32  # nodes of the paper's CM-5

# The paper's random sets are not published, and the number of tetrahedra depends on the set: at 125 sites its
# standard deviation is 2 %. This is the first seed whose sets, at all eight sizes, come within 1 % of the
# paper's numbers of tetrahedra, so that the other columns compare sets of one size. What seeds give that were
# not chosen is printed beside it.
SEED = 21


@dataclass(frozen=True)
class PaperRow:
    """One row of the paper's Table 1 (32-node CM-5, double precision)."""

    name: str
    sites: int
    tetrahedra: int
    depth: int
    seconds: float
    face_expansions: int
    searched: float

    @property
    def per_tetrahedron(self) -> float:
        return self.face_expansions / self.tetrahedra


PAPER = (
    PaperRow("rand.125", 125, 676, 6, 2.42, 1095, 81.7),
    PaperRow("rand.250", 250, 1489, 6, 4.40, 2311, 69.2),
    PaperRow("rand.500", 500, 3037, 6, 7.14, 4693, 65.4),
    PaperRow("rand.1000", 1000, 6361, 7, 11.84, 9732, 73.5),
    PaperRow("rand.2000", 2000, 12947, 7, 26.10, 19717, 85.3),
    PaperRow("rand.4000", 4000, 26252, 8, 61.17, 39812, 80.1),
    PaperRow("rand.8000", 8000, 52895, 8, 125.31, 80120, 88.6),
    PaperRow("rand.16000", 16000, 106693, 9, 299.77, 161060, 88.6),
    PaperRow("dodecahedron", 20, 40, 5, 0.65, 104, 20.0),
    PaperRow("cube", 343, 1296, 5, 6.54, 2417, 133.7),
)


@dataclass(frozen=True)
class Measured:
    """The same columns, measured."""

    tetrahedra: int
    depth: int
    seconds: float
    face_expansions: int
    searched: float
    inconsistencies: int

    @property
    def per_tetrahedron(self) -> float:
        return self.face_expansions / self.tetrahedra


@dataclass(frozen=True)
class Row:
    """A row of both tables; ``others`` holds further random sets of the same size."""

    paper: PaperRow
    ours: Measured
    others: tuple[Measured, ...]

    def spread(self, column: str, digits: int) -> str:
        """Mean and standard deviation of a column over the other sets, as text."""
        values = [getattr(m, column) for m in self.others]
        if not values:
            return ""
        deviation = f" ± {np.std(values, ddof=1):.{digits}f}" if len(values) > 1 else ""
        return f"{np.mean(values):.{digits}f}{deviation}"


def measure(points: np.ndarray, machine: sv.Machine) -> Measured:
    """One run of the paper's method on a machine."""
    tri = Delaunay(points, method="extrapolation", robustness="perturb", machine=machine)
    s = tri.stats
    assert isinstance(s, Statistics)  # what extrapolation counts
    return Measured(
        tetrahedra=len(tri.simplices),
        depth=s.iterations,
        seconds=s.seconds["total"],
        face_expansions=s.face_expansions,
        searched=s.sites_searched / s.face_expansions,
        inconsistencies=s.inconsistencies,
    )


def rows(
    *,
    most_sites: int = 16000,
    other_sets: int = 10,
    seed: int = SEED,
    machine: Callable[[], sv.Machine] = lambda: sv.Simulated(processors=PROCESSORS),
    on_row: Callable[[Row], object] = lambda row: None,
) -> list[Row]:
    """Measure all sets of up to ``most_sites`` sites.

    Sizes above 800 sites get fewer other sets, so that each size costs about the same.
    """
    out = []
    for paper in PAPER:
        if paper.sites > most_sites:
            continue
        random = paper.name.startswith("rand.")
        points = sets.rand(paper.sites, seed) if random else getattr(sets, paper.name)()
        ours = measure(points, machine())
        count = min(other_sets, max(1, 8000 // paper.sites)) if random and other_sets else 0
        others = (measure(sets.rand(paper.sites, seed + 1 + k), machine()) for k in range(count))
        out.append(Row(paper, ours, tuple(others)))
        on_row(out[-1])
    return out


def table1(
    out: Path, console: Console, *, most_sites: int = 16000, other_sets: int = 10, seed: int = SEED
) -> list[Row]:
    """The paper's Table 1 beside ours, on the sets that can be made again: random ones, cube, dodecahedron.

    Prints both, and writes ``table1.csv`` and ``table1.png`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    with console.status(f"{PAPER[0].name} ...") as status:
        measured = rows(
            most_sites=most_sites,
            other_sets=other_sets,
            seed=seed,
            on_row=lambda row: status.update(f"{row.paper.name} done: {row.ours.tetrahedra} tetrahedra"),
        )
    _print(measured, console, seed)
    _write_csv(measured, out / "table1.csv")
    _draw(measured, out / "table1.png")
    console.print(f"wrote {out / 'table1.csv'} and {out / 'table1.png'}")
    return measured


def _print(measured: list[Row], console: Console, seed: int) -> None:
    from rich.table import Table

    table = Table(
        title=f"Teng et al. 1993, Table 1: paper / ours ({PROCESSORS} simulated processors, float64)"
    )
    for column in (
        "set",
        "tetrahedra",
        "diff",
        "depth",
        "expansions",
        "a tetrahedron",
        "searched",
        "inconsistent",
    ):
        table.add_column(column, justify="left" if column == "set" else "right")
    spread = Table(title=f"Random sets of {len(measured[0].others)} and fewer other seeds: mean ± deviation")
    for column in ("set", "sets", "tetrahedra", "depth", "expansions a tetrahedron", "searched"):
        spread.add_column(column, justify="left" if column == "set" else "right")
    for row in measured:
        p, o = row.paper, row.ours
        table.add_row(
            p.name,
            f"{p.tetrahedra} / {o.tetrahedra}",
            f"{100 * (o.tetrahedra / p.tetrahedra - 1):+.2f} %",
            f"{p.depth} / {o.depth}",
            f"{p.face_expansions} / {o.face_expansions}",
            f"{p.per_tetrahedron:.3f} / {o.per_tetrahedron:.3f}",
            f"{p.searched:.1f} / {o.searched:.1f}",
            str(o.inconsistencies),
        )
        if row.others:
            spread.add_row(
                p.name,
                str(len(row.others)),
                row.spread("tetrahedra", 0),
                row.spread("depth", 1),
                row.spread("per_tetrahedron", 3),
                row.spread("searched", 1),
            )
    console.print(table)
    if spread.row_count:
        console.print(spread)
    console.print(
        f"The paper's random sets are not published; ours have seed {seed}. The default seed is the first "
        "whose sets have within 1 % of the paper's tetrahedra at every size; the second table has seeds that "
        "were not chosen. The paper's other sets (torus, m1, spiral, bust, ...) are not published either."
    )


def _write_csv(measured: list[Row], path: Path) -> None:
    columns = ("tetrahedra", "depth", "seconds", "face_expansions", "searched")
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        names: list[Any] = [f"{who}_{c}" for c in columns for who in ("paper", "ours")]
        writer.writerow(["set", "sites", *names, "inconsistencies", "other_sets_tetrahedra"])
        for row in measured:
            values = [getattr(who, c) for c in columns for who in (row.paper, row.ours)]
            others = " ".join(str(m.tetrahedra) for m in row.others)
            writer.writerow([row.paper.name, row.paper.sites, *values, row.ours.inconsistencies, others])


def _draw(measured: list[Row], path: Path) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    random = [r for r in measured if r.paper.name.startswith("rand.")]
    n = [r.paper.sites for r in random]
    panels: tuple[tuple[str, Callable[[Any, int], float]], ...] = (
        ("tetrahedra a site", lambda m, sites: m.tetrahedra / sites),
        ("face expansions a tetrahedron", lambda m, sites: m.per_tetrahedron),
        ("sites searched an expansion", lambda m, sites: m.searched),
    )
    figure = Figure(figsize=(12, 3.8), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, (title, value) in zip(figure.subplots(1, 3), panels, strict=True):
        for r in random:
            grey = [value(m, r.paper.sites) for m in r.others]
            axes.plot([r.paper.sites] * len(grey), grey, ".", color="0.7")
        axes.plot([], [], ".", color="0.7", label="other random sets")
        axes.plot(n, [value(r.paper, r.paper.sites) for r in random], "s-", color="tab:orange", label="paper")
        axes.plot(n, [value(r.ours, r.paper.sites) for r in random], "o-", color="tab:blue", label="dt3d")
        axes.set(xscale="log", xlabel="sites", title=title)
        axes.set_xticks(n, [str(k) for k in n], rotation=30)
        axes.minorticks_off()
        if "searched" in title:
            axes.set_ylim(bottom=0)
    axes.legend()
    figure.savefig(path, dpi=120)

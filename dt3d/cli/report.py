"""What the command line prints about a triangulation: its growth, its counts, its ledger."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .._stats import InsertionStatistics, Progress, Statistics
from .._status import one_line

if TYPE_CHECKING:
    import scanvec as sv

    from .. import threaded2d
    from ..delaunay import Delaunay


def say(console: Console, text: str) -> None:
    """Print a line with names of files, which may hold anything."""
    console.print(one_line(text), markup=False, soft_wrap=True)


class Growth:
    """Prints one line per iteration, as the triangulation grows; to be passed as ``callback``."""

    def __init__(self, console: Console, left: str = "open faces") -> None:
        self.console = console
        self.left = left

    def __call__(self, progress: Progress) -> None:
        """Print the line of one iteration."""
        if progress.iteration == 1:
            self.console.print(f"[dim]iteration   tetrahedra {self.left:>12s}   seconds[/]")
        self.console.print(
            f"{progress.iteration:9d} {progress.tetrahedra:12,} {progress.remaining:12,} "
            f"{progress.seconds:9.2f}",
            highlight=False,
        )


def stats_table(tri: Delaunay, title: str) -> Table:
    """The counts and times of a triangulation."""
    stats = tri.stats
    table = _sizes(tri, title, "tetrahedra", "faces")
    if isinstance(stats, InsertionStatistics):
        for name in ("walked", "tested", "created"):
            table.add_row(f"tetrahedra {name} per site", _ratio(getattr(stats, name), len(tri.points)))
    elif isinstance(stats, Statistics):
        _add_extrapolation(table, stats, len(tri.simplices))
    table.add_row("inconsistencies", f"{stats.inconsistencies:,}")
    return _timed(table, stats.seconds)


def plane_table(tri: threaded2d.Delaunay, title: str) -> Table:
    """The counts and times of a triangulation in the plane."""
    stats = tri.stats
    table = _sizes(tri, title, "triangles", "edges")
    table.add_row("method", stats.method)
    table.add_row("threads", f"{stats.threads}")
    table.add_row("triangles visited per site", _ratio(stats.visited, len(tri.points)))
    table.add_row("edges flipped per site", _ratio(stats.flips, len(tri.points)))
    return _timed(table, stats.seconds)


def _sizes(tri: Delaunay | threaded2d.Delaunay, title: str, simplices: str, facets: str) -> Table:
    """A table with the numbers of sites and of what they make."""
    table = Table(title=Text(title), show_header=False, title_justify="left")
    table.add_column("what")
    table.add_column("value", justify="right")
    table.add_row("sites", f"{len(tri.points):,}")
    table.add_row("duplicates", f"{len(tri.duplicates):,}")
    table.add_row(simplices, f"{len(tri.simplices):,}")
    table.add_row(f"{facets} of the hull", f"{len(tri.convex_hull):,}")
    table.add_section()
    return table


def _timed(table: Table, seconds: dict[str, float]) -> Table:
    """The table with the seconds of each phase below it."""
    table.add_section()
    for phase, spent in seconds.items():
        table.add_row(f"seconds: {phase}", f"{spent:.3f}", style="bold" if phase == "total" else None)
    return table


def _add_extrapolation(table: Table, stats: Statistics, tetrahedra: int) -> None:
    table.add_row("iterations", f"{stats.iterations:,}")
    table.add_row("found in each", "\n".join(f"{found:,}" for found in stats.tetrahedra_per_iteration))
    table.add_row("face expansions", f"{stats.face_expansions:,}")
    table.add_row("expansions per tetrahedron", _ratio(stats.face_expansions, tetrahedra))
    table.add_row("sites searched per expansion", _ratio(stats.sites_searched, stats.face_expansions))
    table.add_row("decided exactly", f"{stats.exact_decisions:,}")


def ledger_table(ledger: sv.Ledger) -> Table:
    """What a simulated machine did, by phase and in all, and what its busiest processors did in each step."""
    table = Table(title="Steps of the simulated machine", title_justify="left")
    table.add_column("phase")
    for heading in ("steps", "elements", "busiest's", "messages", "busiest's"):
        table.add_column(heading, justify="right")
    rows = ledger.table("phase")
    names = ("steps", "elements", "vp_steps", "messages", "busiest")
    for row in rows:
        table.add_row(row.phase or "(outside)", *(f"{getattr(row, name):,}" for name in names))
    table.add_section()
    table.add_row("in all", *(f"{sum(getattr(row, name) for row in rows):,}" for name in names), style="bold")
    return table


def _ratio(a: int, b: int) -> str:
    return f"{a / b:.2f}" if b else "-"

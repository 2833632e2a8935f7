"""What the command line prints about a triangulation: its growth, its counts, its ledger."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ._stats import InsertionStatistics, Statistics


class Growth:
    """Prints one line an iteration, as the triangulation grows; to be passed as ``callback``."""

    def __init__(self, console: Console, left: str = "open faces") -> None:
        self.console = console
        self.left = left

    def __call__(self, progress: Any) -> None:
        if progress.iteration == 1:
            self.console.print(f"[dim]iteration   tetrahedra {self.left:>12s}   seconds[/]")
        self.console.print(
            f"{progress.iteration:9d} {progress.tetrahedra:12,} {progress.open_faces:12,} "
            f"{progress.seconds:9.2f}",
            highlight=False,
        )


def stats_table(tri: Any, title: str) -> Table:
    """The counts and times of a triangulation.

    Parameters
    ----------
    tri : Delaunay
    title : str

    Returns
    -------
    rich.table.Table
    """
    stats = tri.stats
    tetrahedra = len(tri.simplices)
    table = Table(title=Text(title), show_header=False, title_justify="left")
    table.add_column("what")
    table.add_column("value", justify="right")
    table.add_row("sites", f"{len(tri.points):,}")
    table.add_row("duplicates", f"{len(tri.duplicates):,}")
    table.add_row("tetrahedra", f"{tetrahedra:,}")
    table.add_row("faces of the hull", f"{len(tri.convex_hull):,}")
    table.add_section()
    if isinstance(stats, InsertionStatistics):
        for name in ("walked", "tested", "created"):
            table.add_row(f"tetrahedra {name} per site", _ratio(getattr(stats, name), len(tri.points)))
    else:
        _add_extrapolation(table, stats, tetrahedra)
    table.add_row("inconsistencies", f"{stats.inconsistencies:,}")
    table.add_section()
    for phase, seconds in stats.seconds.items():
        style = "bold" if phase == "total" else None
        table.add_row(f"seconds: {phase}", f"{seconds:.3f}", style=style)
    return table


def plane_table(tri: Any, title: str) -> Table:
    """The counts and times of a triangulation in the plane.

    Parameters
    ----------
    tri : threaded2d.Delaunay
    title : str

    Returns
    -------
    rich.table.Table
    """
    stats = tri.stats
    table = Table(title=Text(title), show_header=False, title_justify="left")
    table.add_column("what")
    table.add_column("value", justify="right")
    table.add_row("sites", f"{len(tri.points):,}")
    table.add_row("duplicates", f"{len(tri.duplicates):,}")
    table.add_row("triangles", f"{len(tri.triangles):,}")
    table.add_row("edges of the hull", f"{len(tri.convex_hull):,}")
    table.add_section()
    table.add_row("method", stats.method)
    table.add_row("threads", f"{stats.threads}")
    table.add_row("triangles visited per site", _ratio(stats.visited, len(tri.points)))
    table.add_row("edges flipped per site", _ratio(stats.flips, len(tri.points)))
    table.add_section()
    for phase, seconds in stats.seconds.items():
        style = "bold" if phase == "total" else None
        table.add_row(f"seconds: {phase}", f"{seconds:.3f}", style=style)
    return table


def _add_extrapolation(table: Table, stats: Statistics, tetrahedra: int) -> None:
    table.add_row("iterations", f"{stats.iterations:,}")
    table.add_row("found in each", "\n".join(f"{found:,}" for found in stats.tetrahedra_per_iteration))
    table.add_row("face expansions", f"{stats.face_expansions:,}")
    table.add_row("expansions per tetrahedron", _ratio(stats.face_expansions, tetrahedra))
    table.add_row("sites searched per expansion", _ratio(stats.sites_searched, stats.face_expansions))
    table.add_row("decided exactly", f"{stats.exact_decisions:,}")


def ledger_table(ledger: Any) -> Table:
    """What a simulated machine did, by phase, and in all; both again for the busiest processor of each step.

    Parameters
    ----------
    ledger : scanvec.Ledger

    Returns
    -------
    rich.table.Table
    """
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

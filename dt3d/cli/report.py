"""What the command line prints about a triangulation: its growth, its counts, its ledger."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .._stats import InsertionStatistics, Progress, Statistics
from .._status import one_line

if TYPE_CHECKING:
    import scanvec as sv

    from ..delaunay import Delaunay


def say(console: Console, text: str) -> None:
    """Print a line with names of files, which may hold anything."""
    console.print(one_line(text), markup=False, soft_wrap=True)


class Growth:
    """Prints one line per iteration, as the triangulation grows; to be passed as ``callback``."""

    def __init__(self, console: Console) -> None:
        self.console = console

    def __call__(self, progress: Progress) -> None:
        """Print the line of one iteration."""
        if progress.iteration == 1:
            self.console.print("[dim]iteration   tetrahedra   open faces   seconds[/]")
        self.console.print(
            f"{progress.iteration:9d} {progress.tetrahedra:12,} {progress.remaining:12,} "
            f"{progress.seconds:9.2f}",
            highlight=False,
        )


def table_of(
    tri: Delaunay, title: str, *, details: bool = False, files: Mapping[str, float] | None = None
) -> Table:
    """The counts and times of a triangulation.

    Parameters
    ----------
    tri : Delaunay
        In space or in the plane.
    title : str
        Above the table.
    details : bool
        Also the counts of an insertion, which only its developers need; those of an extrapolation are the
        paper's, and always there.
    files : mapping of str to float, optional
        Seconds of reading, verifying and writing.
    """
    stats, n = tri.stats, len(tri.points)
    table = _sizes(tri, title)
    if isinstance(stats, Statistics):
        table.add_row("method", "extrapolation")
        _add_extrapolation(table, stats, len(tri.simplices))
        table.add_row("inconsistencies", f"{stats.inconsistencies:,}")
        return _timed(table, stats.seconds, files or {})
    counts = {}
    if isinstance(stats, InsertionStatistics):
        counts["tetrahedra walked through per site"] = _ratio(stats.walked, n)
        counts["tetrahedra tested per site"] = _ratio(stats.tested, n)
        counts["tetrahedra made per site"] = _ratio(stats.created, n)
        counts["sites put off for another thread"] = f"{stats.deferred:,}"
        table.add_row("method", "insertion")
    else:
        counts["triangles visited per site"] = _ratio(stats.visited, n)
        counts["edges flipped per site"] = _ratio(stats.flips, n)
        table.add_row("method", stats.method)
    table.add_row("threads", f"{stats.threads}")
    for name, count in counts.items() if details else ():
        table.add_row(name, count)
    return _timed(table, stats.seconds, files or {})


def result_of(tri: Delaunay, files: Mapping[str, float]) -> dict[str, object]:
    """The same for programs: counts by name, with the names that the classes have."""
    counts = {
        name: value
        for name, value in vars(tri.stats).items()
        if name != "seconds" and isinstance(value, int | str | tuple)
    }
    return {
        "dimension": tri.ndim,
        "sites": len(tri.points),
        "duplicates": len(tri.duplicates),
        "simplices": len(tri.simplices),
        "hull_facets": len(tri.convex_hull),
        "statistics": counts,
        "seconds": {**files, **tri.stats.seconds},
    }


def _sizes(tri: Delaunay, title: str) -> Table:
    """A table with the numbers of sites and of what they make."""
    simplices, facets = ("triangles", "edges") if tri.ndim == 2 else ("tetrahedra", "faces")
    table = Table(title=Text(title), show_header=False, title_justify="left")
    table.add_column("what")
    table.add_column("value", justify="right")
    table.add_row("sites", f"{len(tri.points):,}")
    table.add_row("duplicates", f"{len(tri.duplicates):,}")
    table.add_row(simplices, f"{len(tri.simplices):,}")
    table.add_row(f"{facets} of the hull", f"{len(tri.convex_hull):,}")
    table.add_section()
    return table


def _timed(table: Table, seconds: Mapping[str, float], files: Mapping[str, float]) -> Table:
    """The table with the seconds of each phase below it, and those of what is done with files."""
    table.add_section()
    for phase, spent in seconds.items():
        table.add_row(f"seconds: {phase}", f"{spent:.3f}", style="bold" if phase == "total" else None)
    for step, spent in files.items():
        table.add_row(f"seconds: {step}", f"{spent:.3f}")
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

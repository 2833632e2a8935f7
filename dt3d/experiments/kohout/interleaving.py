"""Section 4.2: are speed-ups beyond the number of processors caches, or waiting for memory?"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..._numba.cores import available_cores
from ...threaded2d.options import PlaneOptions
from . import sets
from .busy import warn_if_busy
from .costs import SHIPPED_NAME, chosen_costs, points_of
from .paper import BATCH, CIRCUMCIRCLE
from .report import Row, publish
from .runs import SpeedupSet, lines_over, measured_note, threads_for

if TYPE_CHECKING:
    from rich.console import Console

METHODS = ("sequential", "batch", "circumcircle")


def interleaving(
    out: Path, console: Console, *,
    points: int = 100_000, repeats: int = 5, searches: str = "1,2,4,8,16", data: str = "uniform",
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, section 4.2: speed-ups by searches that a thread goes on with in turn, measured.

    The paper takes speed-ups of more than two on two processors for an effect of caches. Here several
    searches of one thread wait for memory together, so that the share of waiting in the time shows; and each
    method is also compared with one thread that interleaves as many searches.
    """
    warn_if_busy(console)
    given = SpeedupSet(data, points_of(data, points), chosen_costs(SHIPPED_NAME))
    rows: list[Row] = []
    processors = available_cores()
    for count in sets.sizes(searches):
        way: PlaneOptions = {"preset": "kohout2004", "interleave": count}
        row: Row = {"searches": count}
        for method in METHODS:
            threads = threads_for(method, processors) if method != "sequential" else 1
            here = given.measured(method, threads, repeats, way)
            row |= {method: here.median, f"{method} quartiles": here.quartiles}
            if method != "sequential":
                like = given.measured(method, threads, repeats, way, {"interleave": count})
                row |= {
                    f"{method}, like with like": like.median,
                    f"{method}, like, quartiles": like.quartiles,
                }
        rows.append(row)
    alone = max(row["sequential"] for row in rows)
    both = [row[f"{method}, like with like"] for row in rows for method in METHODS[1:]]
    note = (
        f"One thread gains {alone:.2f} from interleaving alone. Like with like {processors} processors give "
        f"{min(both):.2f} to {max(both):.2f}; the paper has "
        f"{BATCH[100_000][1]} to {BATCH[100_000][2]} (batch) and {CIRCUMCIRCLE[100_000][1]} to "
        f"{CIRCUMCIRCLE[100_000][2]} (circum-circle) for one search at a time on two. What caches of that "
        "time did cannot be told from here. "
        f"{measured_note(repeats)}"
    )
    styles = {"sequential": "o-", "batch": "s-", "circumcircle": "^-"}
    styles |= {f"{m}, like with like": f"{k}--" for m, k in zip(METHODS[1:], "s^", strict=True)}
    publish(
        "kohout-interleave", f"Kohout et al. 2004, section 4.2: caches or latency, {points:,} {data} points",
        rows, out, console, lines_over(rows, "searches", styles, "speed-up"), note,
    )  # fmt: skip
    return rows

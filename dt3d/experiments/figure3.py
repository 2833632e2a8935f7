"""Figure 3 of Teng et al. 1993: tetrahedra found in each iteration, for random sets."""

from __future__ import annotations

from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING

import scanvec as sv

from ._output import new_table, panels, publish
from .paper import MOST_BY_ITERATION, RANDOM
from .runs import SEED, Measured, measure, points_of

if TYPE_CHECKING:
    from rich.console import Console


def figure3(out: Path, console: Console, *, most_sites: int = 16000, seed: int = SEED) -> dict[str, Measured]:
    """Teng et al. 1993, Figure 3: tetrahedra of random sets by the iteration that finds them.

    Its values are in a picture only; the depths are those of Table 1. Writes ``figure3.csv``,
    ``figure3.png`` and ``figure3.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    found: dict[str, Measured] = {}
    with console.status("...") as status:
        for row in RANDOM:
            if row.sites <= most_sites:
                status.update(f"{row.name} ...")
                found[row.name] = measure(points_of(row.name, seed), sv.Device())
    table = new_table(
        "Teng et al. 1993, Figure 3: tetrahedra found in each iteration, by sites (ours)",
        ("iteration",),
        (name.removeprefix("rand.") for name in found),
    )
    longest = max(len(m.per_iteration) for m in found.values())
    for k in range(longest):
        news = [str(m.per_iteration[k]) if k < len(m.per_iteration) else "" for m in found.values()]
        table.add_row(str(k + 1), *news)
    shares = [f"{100 * _share(m, MOST_BY_ITERATION):.1f}" for m in found.values()]
    table.add_row(f"% by the {MOST_BY_ITERATION}th", *shares)
    depths = {row.name: row.depth for row in RANDOM}
    table.add_row("depth", *(str(m.depth) for m in found.values()))
    table.add_row("depth, paper", *(str(depths[name]) for name in found))
    table.show(console)
    least = min(_share(m, MOST_BY_ITERATION) for m in found.values())
    console.print(
        f"By iteration {MOST_BY_ITERATION} at least {100 * least:.1f} % are found; paper: most. The last "
        "iteration may find the hull only."
    )
    header = ["set", "iteration", "tetrahedra", "tetrahedra_so_far"]
    lines = [
        (name, k, new, total)
        for name, m in found.items()
        for k, (new, total) in enumerate(zip(m.per_iteration, accumulate(m.per_iteration), strict=True), 1)
    ]
    figure, (ax,) = panels(1, 6.0)
    for name, m in found.items():
        some = [(k, new) for k, new in enumerate(m.per_iteration, 1) if new]
        ax.semilogy(*zip(*some, strict=True), "o-", label=name)
    ax.set(xlabel="iteration", ylabel="tetrahedra found")
    ax.legend(fontsize=8)
    publish(console, out, "figure3", header, lines, figure)
    return found


def _share(m: Measured, iteration: int) -> float:
    return sum(m.per_iteration[:iteration]) / m.tetrahedra

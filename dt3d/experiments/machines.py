"""One run on every machine model, from 2^4 to 2^20 processors: what Teng et al. 1993, section 6, conjecture.

The tetrahedra and the steps do not depend on the number of processors, so one run counts the loads of all of
them: what crosses between processors is counted anew for each number, from the same indices.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import scanvec as sv

from ._output import new_table, panels, print_model, publish
from .runs import SEED, measure, points_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

MODELS = (sv.EREW_PRAM, sv.CRCW_PRAM, sv.SCAN, sv.HYPERCUBE, sv.MESH2D, sv.CM2, sv.CM5)
PROCESSORS = tuple(2**k for k in range(4, 21, 2))


def run(n: int, processors: Sequence[int] = PROCESSORS, seed: int = SEED) -> dict[int, sv.Ledger]:
    """The main loop's ledgers for n random sites by number of processors, accesses counted."""
    first, *others = processors
    machine = sv.Simulated(first, model=sv.EREW_PRAM, also=others)
    return measure(points_of(f"rand.{n}", seed), machine).ledgers


def machines(out: Path, console: Console, *, sites: int = 2000, seed: int = SEED) -> dict[int, sv.Ledger]:
    """Teng et al. 1993, section 6: predicted seconds of one random set, seven models, 2^4 to 2^20 processors.

    Writes ``machines.csv``, ``machines.png`` and ``machines.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    with console.status(f"{sites} sites, loads of {len(PROCESSORS)} machines ..."):
        ledgers = run(sites, seed=seed)
    seconds = {m.name: {p: ledger.under(m).seconds for p, ledger in ledgers.items()} for m in MODELS}
    table = new_table(
        f"Seconds of the main loop for {sites} random sites, by processors", ("processors",), seconds
    )
    for p in ledgers:
        table.add_row(f"{p:,}", *(f"{by[p]:.4g}" for by in seconds.values()))
    table.show(console)
    conflicts = len(next(iter(ledgers.values())).conflicts)
    steps = next(iter(ledgers.values())).steps
    console.print(
        f"Of {steps:,} steps, {conflicts:,} read or write one place more than once, which an EREW PRAM does "
        "not allow: its time has them done by sorting."
    )
    console.print(
        "Loads are exact for every number of processors; the models are what is rough. CM-2 and CM-5 are "
        "taken beyond the sizes that were built (65,536 and 1,024 processors); the CM-2 computes in single "
        "precision, while these loads are of double. The mesh's traffic through its middle is taken as of "
        "random places. Abstract machines count steps of a microsecond, by convention: compare the shape of "
        "their curves."
    )
    for m in MODELS:
        print_model(console, m)
    lines = [[p, *(by[p] for by in seconds.values())] for p in ledgers]
    publish(console, out, "machines", ["processors", *seconds], lines, _draw(seconds))
    return ledgers


def _draw(seconds: dict[str, dict[int, float]]) -> Figure:
    figure, axes = panels(2, 4.5)
    for name, by in seconds.items():
        p = list(by)
        axes[0].plot(p, list(by.values()), "o-", label=name)
        axes[1].plot(p, [by[p[0]] / s for s in by.values()], "o-", label=name)
    axes[1].plot(p, [q / p[0] for q in p], ":", color="0.6", label="linear")
    axes[0].set(xlabel="processors", ylabel="predicted seconds")
    axes[1].set(xlabel="processors", ylabel=f"speed-up over {p[0]} processors")
    for ax in axes:
        ax.set_xscale("log", base=2)
        ax.set_yscale("log")
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure

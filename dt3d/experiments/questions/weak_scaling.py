"""Does it matter that a scan is a primitive? Sites and processors grow together, under every machine model.

Teng et al. 1993, section 6, expects poly-logarithmic time on O(n) processors, "considering the costs of the
scan-vector primitives". Each model is taken as it is, and with scans across processors that cost one step, as
in the scan model; the CM-5, which has a network for scans, also with scans sent as messages.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import scanvec as sv

from .. import sets
from .._output import new_table, panels, publish
from ..runs import SEED, measure

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

EACH = (1, 16, 64)  # sites per processor
SIZES = tuple(4**k for k in range(3, 8))
MODELS = (sv.SCAN, sv.CRCW_PRAM, sv.EREW_PRAM, sv.HYPERCUBE, sv.MESH2D, sv.CM2, sv.CM5)
WITHOUT = "CM5 by messages"  # a CM-5 without its control network


class Weak(NamedTuple):
    """A row of weak-scaling.csv: predicted seconds of the main loop under one model.

    ``share`` is that of scans; ``primitive`` are the seconds if a scan across processors were one step, nan
    for the Connection Machines.
    """

    sites: int
    processors: int
    each: int
    model: str
    seconds: float
    share: float
    primitive: float


def with_primitive_scans(model: sv.Model) -> sv.Model:
    """A model of unit steps whose scans cost what they do in the scan model."""

    def cost(entry: sv.Entry, processors: int, constants: Mapping[str, float]) -> float:
        chosen = sv.SCAN if entry.primitive == "scan" else model
        return chosen.cost(entry, processors, constants)

    return replace(model, name=f"{model.name}, scans primitive", cost=cost)


def cm5_by_messages(processors: int) -> sv.Model:
    """A CM-5 whose scans go up and down a tree of nodes, a packet to each of its levels."""
    levels = 2 * (processors - 1).bit_length()
    return sv.CM5.calibrated(
        "assumed: a packet for each level of a tree", combine=levels * sv.CM5.values["packet"]
    )


def run(n: int, seed: int = SEED) -> list[Weak]:
    """One random set on n / e processors, for each e of `EACH` that leaves more than one."""
    processors = {n // each: each for each in EACH if n // each > 1}
    first, *others = processors
    machine = sv.Simulated(first, model=sv.EREW_PRAM, also=others)
    ledgers = measure(sets.rand(n, seed), machine).ledgers
    rows = []
    for p, each in processors.items():
        ledger = ledgers[p]
        models = (*MODELS, replace(cm5_by_messages(p), name=WITHOUT))
        rows += [Weak(n, p, each, model.name, *_seconds(ledger, model)) for model in models]
    return rows


def _seconds(ledger: sv.Ledger, model: sv.Model) -> tuple[float, float, float]:
    """All seconds, the share of scans, and the seconds with primitive scans."""
    by = {row.primitive: row.seconds or 0.0 for row in ledger.under(model).table("primitive")}
    every = sum(by.values())
    unit = set(model.constants) == {"step"}
    primitive = ledger.under(with_primitive_scans(model)).seconds if unit else np.nan
    return every, by.get("scan", 0.0) / every, primitive


def exponent(sites: list[int], seconds: list[float]) -> float:
    """q of seconds ~ (log2 sites)^q, by least squares of the logarithms."""
    return float(np.polyfit(np.log(np.log2(sites)), np.log(seconds), 1)[0])


def weak_scaling(out: Path, console: Console, *, most_sites: int = 1024, seed: int = SEED) -> list[Weak]:
    """Teng et al. 1993, section 6: sites per processor fixed; what primitive scans are worth, by model.

    Random sets of 64 sites and more, main loop, the paper's preset. Writes ``weak-scaling.csv``,
    ``weak-scaling.png`` and ``weak-scaling.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    rows = []
    with console.status("...") as status:
        for n in (size for size in SIZES if size <= most_sites):
            status.update(f"{n} sites ...")
            rows += run(n, seed)
    for each in EACH:
        _show([row for row in rows if row.each == each], each, console)
    _say(rows, console)
    publish(console, out, "weak-scaling", Weak._fields, rows, _draw(rows))
    return rows


def of_model(rows: list[Weak], each: int, name: str) -> list[Weak]:
    """The rows of one model and so many sites per processor, by sites."""
    return [row for row in rows if row.each == each and row.model == name]


def _names(rows: list[Weak]) -> list[str]:
    return list(dict.fromkeys(row.model for row in rows))


def _show(rows: list[Weak], each: int, console: Console) -> None:
    if not rows:
        return
    names = _names(rows)
    table = new_table(
        f"Sites per processor: {each}. Predicted seconds of the main loop", (), ("sites", *names)
    )
    for n in dict.fromkeys(row.sites for row in rows):
        table.add_row(f"{n:,}", *(f"{row.seconds:.4g}" for row in rows if row.sites == n))
    own = {name: of_model(rows, each, name) for name in names}
    last = [by[-1] for by in own.values()]
    if len(own[names[0]]) > 1:
        powers = [exponent([r.sites for r in by], [r.seconds for r in by]) for by in own.values()]
        table.add_row("q of log^q", *(f"{q:.1f}" for q in powers))
    table.add_row("% in scans", *(f"{100 * row.share:.0f}" for row in last))
    gains = [row.seconds / row.primitive for row in last]
    table.add_row("time / primitive", *("" if np.isnan(g) else f"{g:.2f}" for g in gains))
    table.show(console)


def _say(rows: list[Weak], console: Console) -> None:
    most = max(row.sites for row in rows)
    for each in EACH:
        last = {row.model: row for row in rows if (row.sites, row.each) == (most, each)}
        if last:
            gains = {name: row.seconds / row.primitive for name, row in last.items() if name != sv.SCAN.name}
            some = ", ".join(f"{name} {gain:.2f}" for name, gain in gains.items() if not np.isnan(gain))
            real = last[WITHOUT].seconds / last[sv.CM5.name].seconds
            exclusive = last[sv.EREW_PRAM.name].seconds / last[sv.CRCW_PRAM.name].seconds
            console.print(
                f"{most:,} sites, {each} per processor: scans that are no primitive multiply the time by "
                f"{some}; on a CM-5 without its control network by {real:.2f}. Concurrent accesses that are "
                f"none multiply a PRAM's by {exclusive:.2f}."
            )
    console.print(
        "'q of log^q' fits seconds by a power of log2(sites); 'time / primitive' is the time over that with "
        "scans across processors of one step, for the largest set. A scan first runs over a processor's own "
        "elements, so that the tree matters less with more sites per processor. What this does not show: "
        "constants of real machines other than the Connection Machines, of which those of scanvec.CM5 are "
        "fitted to 32 nodes; and a program written for machines with dear scans, which would use fewer."
    )


def _draw(rows: list[Weak]) -> Figure:
    figure, axes = panels(2, 5.0)
    for k, name in enumerate(_names(rows)):
        own = of_model(rows, EACH[0], name)
        axes[0].plot(
            [r.sites for r in own], [r.seconds / own[0].seconds for r in own], "o-", label=name, color=f"C{k}"
        )
        for each, line in zip(EACH, ("-", "--", ":"), strict=True):
            some = [r for r in of_model(rows, each, name) if not np.isnan(r.primitive)]
            label = f"{name}, {each}"
            if some and name != sv.SCAN.name:
                axes[1].plot(
                    [r.sites for r in some],
                    [r.seconds / r.primitive for r in some],
                    line,
                    marker="o",
                    color=f"C{k}",
                    label=label,
                )
    axes[0].set(xlabel="sites = processors", ylabel="seconds / seconds of the least set", yscale="log")
    axes[1].set(xlabel="sites", ylabel="seconds / seconds with primitive scans")
    for ax in axes:
        ax.set_xscale("log", base=2)
    axes[0].legend(fontsize=8, title="model")
    # beside the axes, where the lines leave no corner free
    title = "model, sites per processor"
    axes[1].legend(fontsize=8, title=title, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure

"""How many first facets suit how many processors? Teng et al. 1993, section 3, begins at every site.

One facet leaves little to do in parallel; a facet of every site has some faces expanded more than once. Here
the paper's method begins with fewer, or with random ones, and the CM-5 model says what its main loop takes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import scanvec as sv

from ...delaunay import Delaunay
from ...extrapolation.buckets import Buckets
from ...extrapolation.dead_faces import distinct_facets
from ...extrapolation.expansion import Perturbed
from ...extrapolation.faces import Face
from ...extrapolation.gift_wrapping import first_facets
from ...extrapolation.loop import extrapolate
from ...extrapolation.perturbation import normalise, perturb
from ...extrapolation.search_options import PAPER_SEARCH
from ...extrapolation.whole_boxes import WHOLE_BOXES
from .. import sets
from .._output import new_table, panels, publish
from ..runs import MAIN_LOOP, SEED
from .levels import facets_of, random_facets

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

NODES = (32, 256, 1024)  # the last is the largest CM-5 that was built
FRACTIONS = (1, 16, 200)  # sites to a first facet
ONE, RANDOM_EACH = "one", "random, each site"
WRAPPING = "first facets"  # the phase of gift wrapping


class Start(NamedTuple):
    """A row of seeds.csv: the main loop from some first facets on so many nodes.

    ``first_seconds`` are those of finding the first facets, nan where they were given.
    """

    sites: int
    start: str
    first_facets: int
    rounds: int
    face_expansions: int
    tetrahedra: int
    nodes: int
    seconds: float
    first_seconds: float


First = Callable[[Buckets], Face[sv.Vector]]


def wrapped(count: int, seed: int, buckets: Buckets) -> Face[sv.Vector]:
    """The paper's first facets of so many random sites, distinct ones."""
    n = len(buckets.origin)
    if count >= n:
        return distinct_facets(Face(*first_facets(buckets)))
    chosen = np.random.default_rng([seed, count]).choice(n, count, replace=False)
    return distinct_facets(Face(*first_facets(buckets, buckets.machine.vector(chosen.astype(np.int32)))))


def given(vertices: np.ndarray, buckets: Buckets) -> Face[sv.Vector]:
    """First facets int (f, 3) that are known, by rows of the sites."""
    order = np.argsort(buckets.origin.to_numpy()).astype(np.int32)
    return distinct_facets(Face(*(buckets.machine.vector(order[column]) for column in vertices.T)))


def starts(sites: np.ndarray, seed: int) -> dict[str, First]:
    """By name, what finds the first facets of sites float64 (n, 3)."""
    n = len(sites)
    counts = {("n" if k == 1 else f"n/{k}"): -(-n // k) for k in FRACTIONS} | {ONE: 1}
    found: dict[str, First] = {name: partial(wrapped, count, seed) for name, count in counts.items()}
    tri = Delaunay(sites)
    facets = facets_of(tri.simplices, tri.neighbors)
    rows = np.unique(random_facets(n, facets, np.random.default_rng([seed, n, 2])))
    return found | {RANDOM_EACH: partial(given, facets.vertices[rows])}


def expand(name: str, sites: np.ndarray, first: First) -> list[Start]:
    """The paper's method on perturbed sites float64 (n, 3) from some facets, a row for each of `NODES`."""
    begun: list[int] = []

    def noted(buckets: Buckets) -> Face[sv.Vector]:
        facets = first(buckets)
        begun.append(len(facets.a))
        return facets

    machine = sv.Simulated(NODES[0], model=sv.CM5, also=NODES[1:])
    out = extrapolate(machine, sites, partial(Perturbed, spec=WHOLE_BOXES), options=PAPER_SEARCH, first=noted)
    counts = begun[0], len(out.per_iteration), out.counts.face_expansions, out.tetrahedra
    rows = []
    for nodes, ledger in machine.ledgers.items():
        wrapping = np.nan if name == RANDOM_EACH else ledger.of(WRAPPING).seconds
        rows.append(Start(len(sites), name, *counts, nodes, ledger.of(*MAIN_LOOP).seconds, wrapping))
    return rows


def run(n: int, seed: int, on_start: Callable[[str], object] = lambda name: None) -> list[Start]:
    """One random set from all starts."""
    sites = perturb(normalise(sets.rand(n, seed)), np.dtype(np.float64), seed)
    rows = []
    for name, first in starts(sites, seed).items():
        on_start(name)
        rows += expand(name, sites, first)
    return rows


def seeds(out: Path, console: Console, *, sites: int = 1000, seed: int = SEED) -> list[Start]:
    """Teng et al. 1993, section 3: rounds, face expansions and CM-5 seconds by the number of first facets.

    One random set, the paper's search. Writes ``seeds.csv``, ``seeds.png`` and ``seeds.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    with console.status("...") as status:
        rows = run(sites, seed, lambda name: status.update(f"{sites} sites, first facets: {name} ..."))
    _show(rows, console)
    _say(rows, console)
    publish(console, out, "seeds", Start._fields, rows, _draw(rows))
    return rows


def _show(rows: list[Start], console: Console) -> None:
    table = new_table(
        f"{rows[0].sites:,} random sites: the main loop from fewer first facets, seconds on a CM-5 of so "
        "many nodes",
        ("from sites",),
        ("first facets", "rounds", "FE", "FE/k", *(f"{p} nodes" for p in NODES), f"finding them, {NODES[0]}"),
    )
    for own in _by_start(rows).values():
        row = own[0]
        table.add_row(
            row.start,
            f"{row.first_facets:,}",
            str(row.rounds),
            f"{row.face_expansions:,}",
            f"{row.face_expansions / row.tetrahedra:.2f}",
            *(f"{r.seconds:.2f}" for r in own),
            "" if np.isnan(row.first_seconds) else f"{row.first_seconds:.2f}",
        )
    table.show(console)


def _by_start(rows: list[Start]) -> dict[str, list[Start]]:
    return {name: [r for r in rows if r.start == name] for name in dict.fromkeys(r.start for r in rows)}


def _say(rows: list[Start], console: Console) -> None:
    for nodes in NODES:
        own = [row for row in rows if row.nodes == nodes]
        found = [row for row in own if row.start != RANDOM_EACH]
        best = min(found, key=lambda row: row.seconds)
        whole = min(found, key=lambda row: row.seconds + row.first_seconds)
        (random,) = (row for row in own if row.start == RANDOM_EACH)
        console.print(
            f"{nodes} nodes: of the paper's facets the main loop is fastest from those of {best.start} sites "
            f"({best.seconds:.2f} s, against {found[0].seconds:.2f} s from all), with the time of finding "
            f"them from those of {whole.start} ({whole.seconds + whole.first_seconds:.2f} s, against "
            f"{found[0].seconds + found[0].first_seconds:.2f} s); from random facets of all sites, which "
            f"were given, it takes {random.seconds:.2f} s ({random.seconds / found[0].seconds - 1:+.0%})."
        )
    console.print(
        "Fewer first facets save few face expansions and cost more rounds, each with the overhead of its "
        "steps and its own imbalance. What this does not show: the time in which random facets could be "
        "found, as they are drawn from a finished triangulation; other machines, and other sets. It is one "
        "set, and the choice of fewer sites is random. The constants are those of scanvec.CM5."
    )


def _draw(rows: list[Start]) -> Figure:
    figure, (ax,) = panels(1, 6.0)
    for k, nodes in enumerate(NODES):
        own = [r for r in rows if r.nodes == nodes and r.start != RANDOM_EACH]
        at = [r.first_facets for r in own]
        ax.loglog(at, [r.seconds for r in own], "o-", color=f"C{k}", label=f"{nodes} nodes, main loop")
        ax.loglog(
            at, [r.seconds + r.first_seconds for r in own], "--", color=f"C{k}",
            label=f"{nodes} nodes, with finding first facets",
        )  # fmt: skip
        (random,) = (r for r in rows if r.nodes == nodes and r.start == RANDOM_EACH)
        ax.loglog([random.first_facets], [random.seconds], "*", color=f"C{k}", markersize=9)
    ax.plot([], [], "*", color="0.4", label="random facets of all sites, given")
    ax.set(xlabel="distinct first facets", ylabel="predicted seconds (CM-5)")
    ax.legend(fontsize=8)
    return figure

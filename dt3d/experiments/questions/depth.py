"""Does the choice of first facets bound the depth? Teng et al. 1993, section 6.

The paper starts at each site with the facet of least circumcircle, sees the depth grow like a logarithm, and
expects facets chosen at random to keep it small whatever the output. Here the depths are counted in finished
triangulations (`levels`), for random sets and for one with quadratically many tetrahedra.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...delaunay import Delaunay
from .. import sets
from .._output import new_table, panels, publish
from ..paper import RANDOM
from ..runs import SEED
from .levels import Growth, facets_of, growth, least_circle, random_facets

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

FEWER = 200  # sites to a first facet, where not every site has one
EACH_LEAST, EACH_RANDOM, ANYWHERE = "least circle", "random of each site", "random of all"
SOME, ONE = f"least circle, n/{FEWER}", "least circle, one"
STARTS = (EACH_LEAST, EACH_RANDOM, ANYWHERE, SOME, ONE)
SIZES = tuple(125 * 2**k for k in range(16))
UNIFORM, LINES = "uniform", "two lines"


def two_lines(n: int, seed: int = 0) -> np.ndarray:
    """Sites at random on two skew lines, float64 (n, 3): every edge of one line meets every one of the other.

    So there are (n/2 - 1)^2 tetrahedra.
    """
    u, v = np.random.default_rng([seed, n]).uniform(-1, 1, (2, n // 2))
    nought, one = np.zeros(n // 2), np.ones(n // 2)
    return np.concatenate([np.column_stack([u, nought, one]), np.column_stack([nought, v, -one])])


KINDS: dict[str, Callable[[int, int], np.ndarray]] = {UNIFORM: sets.rand, LINES: two_lines}


class Depth(NamedTuple):
    """A row of depth.csv: one set, and one choice of first facets."""

    kind: str
    sites: int
    seed: int
    start: str
    tetrahedra: int
    first_facets: int
    depth: int
    rounds: int
    face_expansions: int


def run(kind: str, n: int, seed: int) -> list[Depth]:
    """One set from all starts."""
    points = KINDS[kind](n, seed)
    n, tri = len(points), Delaunay(points)
    facets = facets_of(tri.simplices, tri.neighbors)
    rng = np.random.default_rng([seed, n, 1])
    least = least_circle(points, facets)
    first = {
        EACH_LEAST: least,
        EACH_RANDOM: random_facets(n, facets, rng),
        ANYWHERE: rng.choice(len(facets.vertices), len(np.unique(least)), replace=False),
        SOME: least[rng.choice(n, -(-n // FEWER), replace=False)],
        ONE: least[rng.choice(n, 1)],
    }
    found: dict[str, Growth] = {start: growth(tri.neighbors, facets, rows) for start, rows in first.items()}
    return [
        Depth(kind, n, seed, start, len(tri.simplices), g.first, g.depth, g.rounds, g.face_expansions)
        for start, g in found.items()
    ]


FORMS: Mapping[str, Callable[[np.ndarray], np.ndarray]] = {
    "(log2 n)^(1/3)": lambda n: np.cbrt(np.log2(n)),
    "log2 n": np.log2,
    "n^(1/3)": np.cbrt,
    "n^(1/2)": np.sqrt,
    "n": lambda n: n,
}


LOGARITHMIC = tuple(FORMS)[:2]


class Fit(NamedTuple):
    """depth = constant + slope * form(n), by least squares; ``error`` is the root of the mean square left."""

    form: str
    constant: float
    slope: float
    error: float


def fits(sites: Sequence[int], depth: Sequence[float]) -> list[Fit]:
    """All forms, the nearest one first."""
    out = []
    for form, of in FORMS.items():
        x = of(np.asarray(sites, float))
        slope, constant = np.polyfit(x, depth, 1)
        error = np.sqrt(np.mean((constant + slope * x - depth) ** 2))
        out.append(Fit(form, float(constant), float(slope), float(error)))
    return sorted(out, key=lambda fit: fit.error)


def means(rows: list[Depth], kind: str, start: str, column: str = "depth") -> dict[int, float]:
    """The mean of a column over the sets of each size."""
    by: dict[int, list[float]] = {}
    for row in rows:
        if (row.kind, row.start) == (kind, start):
            by.setdefault(row.sites, []).append(getattr(row, column))
    return {n: float(np.mean(values)) for n, values in by.items()}


def depth(
    out: Path, console: Console, *, most_sites: int = 128000, most_on_lines: int = 2000, sets: int = 3,
    seed: int = SEED,
) -> list[Depth]:  # fmt: skip
    """Teng et al. 1993, section 6: levels of the dual graph from first facets chosen in five ways.

    Uniform sets of 125 sites and more, and sites on two lines, ``sets`` of each size. Writes ``depth.csv``,
    ``depth.png`` and ``depth.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    rows: list[Depth] = []
    with console.status("...") as status:
        for kind, most in ((UNIFORM, most_sites), (LINES, min(most_on_lines, most_sites))):
            for n in (size for size in SIZES if size <= most):
                for k in range(sets):
                    status.update(f"{kind}, {n} sites, set {k + 1} ...")
                    rows += run(kind, n, seed + k)
    for kind in KINDS:
        _show(rows, kind, console)
    _show_fits(rows, console)
    _say(rows, console)
    publish(console, out, "depth", Depth._fields, rows, _draw(rows))
    return rows


def _show(rows: list[Depth], kind: str, console: Console) -> None:
    paper = {row.sites: row for row in RANDOM} if kind == UNIFORM else {}
    printed = ("rounds, paper", "FE/k, paper") if paper else ()
    table = new_table(
        f"{kind}: greatest depth by first facets, mean of {len({row.seed for row in rows})} sets; rounds and "
        f"face expansions a tetrahedron (FE/k) of {EACH_LEAST}",
        (),
        ("sites", "tetrahedra", *STARTS, "rounds", "FE/k", *printed),
    )
    rounds = means(rows, kind, EACH_LEAST, "rounds")
    ratio = {start: _ratio(rows, kind, start) for start in STARTS}
    for n, tetrahedra in means(rows, kind, EACH_LEAST, "tetrahedra").items():
        theirs = [str(paper[n].depth), f"{paper[n].per_tetrahedron:.2f}"] if n in paper else ["", ""]
        table.add_row(
            f"{n:,}",
            f"{tetrahedra:,.0f}",
            *(f"{means(rows, kind, start)[n]:.1f}" for start in STARTS),
            f"{rounds[n]:.1f}",
            f"{ratio[EACH_LEAST][n]:.2f}",
            *theirs[: len(printed)],
        )
    table.show(console)
    largest = max(rounds)
    texts = ", ".join(f"{start} {by[largest]:.2f}" for start, by in ratio.items())
    console.print(f"Face expansions a tetrahedron at {largest:,} sites: {texts}.")


def _ratio(rows: list[Depth], kind: str, start: str) -> dict[int, float]:
    every = means(rows, kind, start, "tetrahedra")
    return {n: fe / every[n] for n, fe in means(rows, kind, start, "face_expansions").items()}


def _show_fits(rows: list[Depth], console: Console) -> None:
    table = new_table(
        "depth = a + b f(sites), by least squares: the root of the mean square that each f leaves, in levels",
        ("sites", "first facets", "nearest f"),
        ("a", "b", *FORMS),
    )
    for kind in KINDS:
        for start in STARTS:
            mean = means(rows, kind, start)
            if len(mean) > 2:
                found = fits(list(mean), list(mean.values()))
                errors = {fit.form: f"{fit.error:.2f}" for fit in found}
                near = found[0]
                numbers = f"{near.constant:.3g}", f"{near.slope:.3g}"
                table.add_row(kind, start, near.form, *numbers, *(errors[form] for form in FORMS))
    if table.row_count:
        table.show(console)


def _say(rows: list[Depth], console: Console) -> None:
    for kind in KINDS:
        ends = []
        for start in STARTS:
            mean = means(rows, kind, start)
            if len(mean) > 1:
                first, *_, last = mean
                power = np.log(mean[last] / mean[first]) / np.log(last / first)
                ends.append(f"{start} {mean[first]:.1f} to {mean[last]:.1f}, like n^{power:.2f}")
        if ends:
            console.print(f"{kind}, {first:,} to {last:,} sites: {'; '.join(ends)}.")
    each = means(rows, UNIFORM, EACH_LEAST, "first_facets")
    for n in [max(each)] if each else []:
        console.print(
            f"{n:,} uniform sites have {each[n]:,.0f} distinct facets of least circle, as neighbours choose "
            f"the same one, and {means(rows, UNIFORM, EACH_RANDOM, 'first_facets')[n]:,.0f} random ones. "
            f"'{ANYWHERE}' are as many as the former, drawn among all facets: what it gains over them is due "
            "to chance, and what it lacks to the facets of each site is due to their number and spread."
        )
    for kind in KINDS:
        for start in (EACH_LEAST, EACH_RANDOM):
            mean = means(rows, kind, start)
            if len(mean) > 2:
                slow = fits(list(mean), list(mean.values()))[0].form in LOGARITHMIC
                grows = "like a logarithm or its root" if slow else "like a power of the sites"
                console.print(f"{kind}, {start}: the depth grows {grows}.")
    console.print(
        "The two lines have quadratically many tetrahedra. Facets of least circle crowd there where both "
        "lines are near, and random ones are only as many as sites. What this does not show: a random facet "
        "of a site is drawn from a finished triangulation, and the algorithm would have to find it first. "
        "Other shapes and larger sets were not tried. A logarithm and its cube root can hardly be told apart "
        "over so few levels."
    )


def _draw(rows: list[Depth]) -> Figure:
    figure, axes = panels(2, 5.0)
    for ax, kind in zip(axes, KINDS, strict=True):
        for start, mark in zip(STARTS, "os^vD", strict=True):
            mean = means(rows, kind, start)
            ax.plot(list(mean), list(mean.values()), f"{mark}-", label=start)
        ax.set(title=kind, xlabel="sites", ylabel="greatest depth (levels)")
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xticks(list(mean)[::2], [f"{n:,}" for n in list(mean)[::2]], rotation=30)
        ax.minorticks_off()
    own = {row.sites for row in rows}
    theirs = [row for row in RANDOM if row.sites in own]
    axes[0].plot(
        [row.sites for row in theirs], [row.depth for row in theirs], "kx", label="rounds, paper (Table 1)"
    )
    rounds = means(rows, UNIFORM, EACH_LEAST, "rounds")
    axes[0].plot(list(rounds), list(rounds.values()), "k:", label="rounds, least circle")
    axes[0].legend(fontsize=8)
    return figure

"""How many tetrahedra meet in a site? Teng et al. 1993, section 6, says 24 on average.

In a Poisson process it is 96 pi^2 / 35 = 27.07: a site has 2 + 48 pi^2 / 35 neighbours on average (J. L.
Meijering, Philips Research Reports 8, 1953, 270-290), and the star of an inner site with e edges has 2 e - 4
tetrahedra, by Euler's formula. In a cube the sites near its surface have fewer.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...delaunay import Delaunay
from .. import sets
from .._output import new_table, panels, publish
from ..paper import RANDOM, TABLE1
from ..runs import SEED

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

POISSON = 96 * np.pi**2 / 35  # tetrahedra of a site, on average
SAID = 24  # by section 6
MARGIN = 2.0  # inner sites are so far from the cube's surface, in units of sites^(-1/3)
MARGINS = (0.0, 0.5, 1.0, 2.0, 3.0)
SIZES = tuple(125 * 2**k for k in range(14))


class Degrees(NamedTuple):
    """A row of degrees.csv: tetrahedra of the sites of one set; inner ones nan if few."""

    sites: int
    seed: int
    tetrahedra: int
    mean: float
    inner_sites: int
    inner_mean: float
    inner_deviation: float
    inner_skewness: float


def tetrahedra_of_sites(n: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Of n random sites in the unit cube: tetrahedra int64 (n,), and distance to the surface float64 (n,).

    The distance is in spacings, that is in units of n^(-1/3).
    """
    points = sets.rand(n, seed)
    count = np.bincount(Delaunay(points).simplices.reshape(-1), minlength=n)
    return count, np.minimum(points, 1 - points).min(axis=1) * np.cbrt(n)


def run(n: int, seed: int) -> tuple[Degrees, np.ndarray, np.ndarray]:
    """One set: its row, and what `tetrahedra_of_sites` gives."""
    count, distance = tetrahedra_of_sites(n, seed)
    inner = count[distance > MARGIN]
    moments = (np.nan, np.nan, np.nan)
    if len(inner) > 1:
        mean, deviation = inner.mean(), inner.std()
        moments = mean, deviation, ((inner - mean) ** 3).mean() / deviation**3
    row = Degrees(n, seed, int(count.sum()) // 4, count.mean(), len(inner), *map(float, moments))
    return row, count, distance


def shortfall(sites: list[int], means: list[float]) -> tuple[float, float]:
    """(c, p) of POISSON - mean = c sites^p, by least squares of logarithms; all means are below it."""
    power, constant = np.polyfit(np.log(sites), np.log(POISSON - np.asarray(means)), 1)
    return float(np.exp(constant)), float(power)


def sites_with(mean: float, sites: list[int], means: list[float]) -> float | None:
    """The number of sites that have this mean, between those known; None if it is not there."""
    if not means[0] <= mean <= means[-1]:
        return None
    return float(np.exp(np.interp(mean, means, np.log(sites))))


def degrees(
    out: Path, console: Console, *, most_sites: int = 128000, sets: int = 3, seed: int = SEED
) -> list[Degrees]:
    """Teng et al. 1993, section 6: tetrahedra of a site, which the paper says to be 24 on average.

    Random sets of 125 sites and more, ``sets`` of each size, and 4 k / n of all rows of Table 1. Writes
    ``degrees.csv``, ``degrees.png`` and ``degrees.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    rows = []
    with console.status("...") as status:
        for n in (size for size in SIZES if size <= most_sites):
            for k in range(sets):
                status.update(f"{n} sites, set {k + 1} ...")
                row, count, distance = run(n, seed + k)
                rows.append(row)
    _show(rows, console)
    _show_largest(count, distance, console)
    _say(rows, console)
    publish(console, out, "degrees", Degrees._fields, rows, _draw(rows, count, distance))
    return rows


def by_size(rows: list[Degrees]) -> dict[int, list[Degrees]]:
    """The sets of each number of sites."""
    return {n: [row for row in rows if row.sites == n] for n in dict.fromkeys(row.sites for row in rows)}


def _show(rows: list[Degrees], console: Console) -> None:
    paper = {row.sites: 4 * row.tetrahedra / row.sites for row in RANDOM}
    table = new_table(
        f"Tetrahedra of a site in random sets: all of them (4 k / n), and those {MARGIN:g} spacings inside",
        (),
        ("sites", "all, paper", "all", "over sets", "inner sites", "inner", "deviation", "skewness"),
    )
    for n, own in by_size(rows).items():
        means = [row.mean for row in own]
        inner = [row for row in own if row.inner_sites > 1]
        moments = [(row.inner_mean, row.inner_deviation, row.inner_skewness) for row in inner]
        weights = [row.inner_sites for row in inner]
        texts = [f"{x:.2f}" for x in np.average(moments, axis=0, weights=weights)] if inner else [""] * 3
        table.add_row(
            f"{n:,}",
            f"{paper[n]:.2f}" if n in paper else "",
            f"{np.mean(means):.2f}",
            f"±{np.std(means):.2f}",
            f"{np.mean([row.inner_sites for row in own]):,.0f}",
            *texts,
        )
    table.show(console)
    others = ", ".join(
        f"{row.name} {4 * row.tetrahedra / row.sites:.1f}" for row in TABLE1 if row not in RANDOM
    )
    console.print(f"4 k / n of Table 1's other rows: {others}.")


def _show_largest(count: np.ndarray, distance: np.ndarray, console: Console) -> None:
    table = new_table(
        f"{len(count):,} sites, by the least distance to the surface, in spacings",
        (),
        ("farther than", "sites", "mean", "standard error", "odd"),
    )
    for margin in MARGINS:
        own = count[distance > margin]
        if len(own) > 1:
            error = own.std() / np.sqrt(len(own))
            table.add_row(
                f"{margin:g}", f"{len(own):,}", f"{own.mean():.3f}", f"{error:.3f}", f"{(own % 2).sum():,}"
            )
    table.show(console)


def _say(rows: list[Degrees], console: Console) -> None:
    ours = {n: float(np.mean([r.mean for r in own])) for n, own in by_size(rows).items()}
    theirs = {r.sites: 4 * r.tetrahedra / r.sites for r in RANDOM}
    for whose, means in (("our sets", ours), ("the paper's random sets", theirs)):
        if len(means) > 2:
            sites, values = list(means), list(means.values())
            constant, power = shortfall(sites, values)
            at = sites_with(SAID, sites, values)
            where = "at none of these sizes" if at is None else f"at about {at:,.0f} sites"
            console.print(
                f"4 k / n of {whose} is {SAID} {where}; below {POISSON:.2f} it is by about "
                f"{constant:.0f} n^({power:.2f}), {POISSON - values[-1]:.2f} at {sites[-1]:,} sites."
            )
    console.print(
        f"A Poisson process has 96 pi^2/35 = {POISSON:.2f}. The paper's {SAID} is the mean of small sets, of "
        "whose sites many are near the surface, and not of the large ones in its own Table 1; it also is 4 "
        "times the 6 tetrahedra per site to which section 7 rounds all of its sets. Inner sites have even "
        "numbers, as their stars are closed; a skewness of 0 would be that of a normal distribution. "
        "This is about uniform sites in a cube; 4 k / n of other sets is what their shapes make it."
    )


def _draw(rows: list[Degrees], count: np.ndarray, distance: np.ndarray) -> Figure:
    figure, axes = panels(2, 5.0)
    inner = count[distance > MARGIN]
    inner = inner if len(inner) else count
    edges = [
        k - 0.5 for k in range(0, int(count.max()) + 3, 2)
    ]  # two numbers to a bar, as inner sites have even ones
    axes[0].hist(count, edges, density=True, color="0.8", label=f"all {len(count):,} sites")
    axes[0].hist(
        inner, edges, density=True, histtype="step", color="tab:blue", label=f"inner, mean {inner.mean():.2f}"
    )
    x = np.linspace(0, count.max(), 400)
    deviation = max(inner.std(), 1e-9)
    normal = np.exp(-(((x - inner.mean()) / deviation) ** 2) / 2) / (deviation * np.sqrt(2 * np.pi))
    axes[0].plot(x, normal, color="tab:orange", label="normal, of the inner moments")
    axes[0].axvline(SAID, color="0.4", linestyle="--", label=f"paper's mean, {SAID}")
    axes[0].set(xlabel="tetrahedra of a site", ylabel="share of sites per tetrahedron")
    axes[1].semilogx(
        [row.sites for row in rows], [row.mean for row in rows], "o", label="all sites (4 k / n)"
    )
    some = [row for row in rows if row.inner_sites >= 100]
    axes[1].plot([row.sites for row in some], [row.inner_mean for row in some], "s", label="inner sites")
    axes[1].plot(
        [row.sites for row in RANDOM],
        [4 * row.tetrahedra / row.sites for row in RANDOM],
        "kx",
        label="4 k / n, paper (Table 1)",
    )
    axes[1].axhline(POISSON, color="0.6", linestyle=":", label=f"Poisson process, {POISSON:.2f}")
    axes[1].axhline(SAID, color="0.4", linestyle="--", label=f"paper's mean, {SAID}")
    axes[1].set(xlabel="sites", ylabel="mean tetrahedra of a site")
    for ax in axes:
        ax.legend(fontsize=8)
    return figure

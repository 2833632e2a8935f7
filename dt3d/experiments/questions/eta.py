"""How far to move sites: which eta, in which precision? Teng et al. 1993, section 5.1, do not say.

A perturbation that is small leaves ties of cospherical sites to rounding: the faces of one round contradict
each other, which the dictionary of dead faces notices as duplicates. One that is large gives the Delaunay
triangulation of other sites, which nothing notices. Both are counted here. A tetrahedron is wrong if a site
is strictly inside its circumsphere, by exact predicates on the sites as they came; of cospherical sites
several triangulations are right.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import scanvec as sv

from ..._errors import InconsistencyError, InconsistencyWarning
from ...delaunay import Delaunay
from ...extrapolation.perturbation import MAGNITUDE
from ...predicates import in_sphere, orient3d
from ...verification import verify
from .. import sets
from .._output import new_table, panels, publish
from ..paper import TABLE3, TOO_MANY
from ..runs import SEED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from rich.console import Console

PRECISIONS = ("float64", "float32")
LEAST, LARGEST = 44, 4  # eta is 2^-44 to 2^-4
AT_ONCE = 2**18  # in-sphere tests, to bound the memory


@dataclass(frozen=True)
class Trial:
    """One triangulation by linear perturbation.

    Attributes
    ----------
    name, dtype : str
        The set, and the working precision.
    exponent : int
        eta is 2 to the power of it.
    tetrahedra : int or None
        None if the set was given up.
    duplicates : int
        Inconsistencies that the method itself has noticed: tetrahedra that contradict others, holes.
    wrong, flat : int
        Tetrahedra with a site strictly inside their circumsphere, and those without a volume; exactly.
    proven : bool
        Whether they are a Delaunay triangulation, by `dt3d.verification.verify`.
    """

    name: str
    dtype: str
    exponent: int
    tetrahedra: int | None
    duplicates: int
    wrong: int = 0
    flat: int = 0
    proven: bool = False

    @property
    def silent(self) -> bool:
        """Whether it is not a Delaunay triangulation, and nothing says so."""
        return self.tetrahedra is not None and not self.duplicates and not self.proven

    @property
    def ending(self) -> str:
        """What came of it, in a word."""
        if self.tetrahedra is None:
            return "given up"
        if self.proven:
            return "Delaunay"
        return "wrong, unnoticed" if self.silent else "warning"


def faults(points: np.ndarray, simplices: np.ndarray, right: np.ndarray) -> tuple[int, int]:
    """Tetrahedra with a site of points (n, 3) strictly inside their circumsphere, and flat ones; counted.

    Exactly. Those among ``right``, int (k, 4), the simplices of an exact triangulation, are not looked at.
    """
    known = np.unique(np.sort(right, axis=1), axis=0)
    others = np.unique(np.sort(simplices, axis=1), axis=0)
    both, count = np.unique(np.concatenate([known, others]), axis=0, return_counts=True)
    twice = {tuple(row) for row in both[count == 2]}
    others = np.array([row for row in others if tuple(row) not in twice], int).reshape(-1, 4)
    wrong = flat = 0
    for some in np.array_split(others, max(1, -(-len(others) * len(points) // AT_ONCE))):
        a, b, c, d = (points[some[:, k]] for k in range(4))
        sign = orient3d(a, b, c, d)
        inside = in_sphere(a[:, None], b[:, None], c[:, None], d[:, None], points[None])
        wrong += int((inside * sign[:, None] > 0).any(axis=1).sum())
        flat += int((sign == 0).sum())
    return wrong, flat


def attempt(points: np.ndarray, name: str, dtype: str, exponent: int, right: np.ndarray) -> Trial:
    """Triangulate points (n, 3) with eta = 2^exponent; ``right`` are the simplices of the exact mode."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InconsistencyWarning)
            tri = Delaunay(
                points,
                method="extrapolation",
                machine=sv.Device(),
                robustness="perturb",
                dtype=dtype,
                eta=2.0**exponent,
            )
    except InconsistencyError as error:
        return Trial(name, dtype, exponent, None, error.inconsistencies)
    wrong, flat = faults(points, tri.simplices, right)
    proven = bool(verify(points, tri.simplices))
    return Trial(name, dtype, exponent, len(tri.simplices), tri.stats.inconsistencies, wrong, flat, proven)


def eta(
    out: Path, console: Console, *, most_sites: int = 4000, step: int = 4, seed: int = SEED
) -> list[Trial]:
    """Teng et al. 1993, section 5.1: which eta, in which precision? Duplicate faces and wrong tetrahedra.

    For torus (of the paper's kind), cube and a random set, every ``step``-th power of two. Writes
    ``eta.csv``, ``eta.png`` and ``eta.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    names = ["torus", "cube", f"rand.{most_sites}"]
    trials = []
    with console.status("...") as status:
        for name in names:
            points = sets.named(name, seed)
            right = Delaunay(points).simplices
            for dtype in PRECISIONS:
                for exponent in range(-LEAST, 1 - LARGEST, step):
                    status.update(f"{name}, {dtype}, 2^{exponent} ...")
                    trials.append(attempt(points, name, dtype, exponent, right))
    _table(trials, names, console)
    _conclude(trials, names, console)
    header = ["set", "precision", "log2_eta", "ending", "tetrahedra", "duplicates", "wrong", "flat"]
    lines: list[list[object]] = []
    for t in trials:
        gone = t.tetrahedra is None
        rest = ["", t.duplicates, "", ""] if gone else [t.tetrahedra, t.duplicates, t.wrong, t.flat]
        lines.append([t.name, t.dtype, t.exponent, t.ending, *rest])
    publish(console, out, "eta", header, lines, _draw(trials, names))
    return trials


def _table(trials: list[Trial], names: Sequence[str], console: Console) -> None:
    table = new_table(
        "Duplicate faces noticed / wrong tetrahedra, by eta; given up where there are too many",
        ("eta",),
        (f"{name}, {dtype}" for dtype in PRECISIONS for name in names),
    )
    for exponent in sorted({t.exponent for t in trials}):
        cells = []
        for dtype in PRECISIONS:
            for name in names:
                (t,) = _of(trials, name, dtype, [exponent])
                wrong = f"{t.wrong}" + (f" + {t.flat} flat" if t.flat else "")
                cells.append("given up" if t.tetrahedra is None else f"{t.duplicates} / {wrong}")
        table.add_row(f"2^{exponent}", *cells)
    paper = [str(TABLE3.get(name, "-")) for name in names]
    table.add_section()
    table.add_row("paper, any", *("0" for _ in names), *paper)
    table.show(console)


def _of(trials: Iterable[Trial], name: str, dtype: str, exponents: Sequence[int]) -> list[Trial]:
    return [t for t in trials if (t.name, t.dtype) == (name, dtype) and t.exponent in exponents]


def _conclude(trials: list[Trial], names: Sequence[str], console: Console) -> None:
    exponents = sorted({t.exponent for t in trials})
    for dtype in PRECISIONS:
        by_exponent = {e: [t for t in trials if (t.dtype, t.exponent) == (dtype, e)] for e in exponents}
        good = [f"2^{e}" for e, some in by_exponent.items() if all(t.proven for t in some)]
        quiet = [
            f"2^{e}"
            for e, some in by_exponent.items()
            if all(t.tetrahedra and not t.duplicates for t in some)
        ]
        silent = sum(t.silent for some in by_exponent.values() for t in some)
        default = int(np.log2(MAGNITUDE[np.dtype(dtype)]))
        console.print(
            f"{dtype}: all sets end in a Delaunay triangulation with eta {_listed(good)}; no duplicate face "
            f"is found in any set with {_listed(quiet)}. {silent} of "
            f"{sum(map(len, by_exponent.values()))} runs are wrong and do not say so. dt3d's default is "
            f"2^{default}."
        )
    paper = {name: str(TABLE3[name]) for name in names if name in TABLE3}
    near = {name: [_power(t) for t in _of(trials, name, "float32", exponents) if _like(t)] for name in paper}
    some = "; ".join(f"{name} ({paper[name]}): {_listed(near[name])}" for name in paper)
    common = set.intersection(*map(set, near.values())) if near else set()
    console.print(
        f"In single precision the paper's Table 3 is met, to a factor of two, with these eta: {some}. "
        f"With one eta for all: {_listed(sorted(common))}."
    )
    console.print(
        "Wrong tetrahedra have a site strictly inside their circumsphere. It does not show what the paper's "
        "eta was, nor what other matrices M give: each run has the same one. The paper's torus is not "
        "published: ours is of its kind only."
    )


def _like(trial: Trial) -> bool:
    """Whether a run ended as the paper's Table 3 has it: given up as there, or within a factor of two."""
    paper = TABLE3[trial.name]
    if paper == TOO_MANY or trial.tetrahedra is None:
        return paper == TOO_MANY and trial.tetrahedra is None
    return int(paper) / 2 <= trial.duplicates <= 2 * int(paper)


def _power(trial: Trial) -> str:
    return f"2^{trial.exponent}"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words) or "none"


def _draw(trials: list[Trial], names: Sequence[str]) -> Figure:
    figure, axes = panels(4, 4.5)
    finished = [t for t in trials if t.tetrahedra is not None]
    top = 4 * max(10, *(max(t.duplicates, t.wrong) for t in finished))
    for k, dtype in enumerate(PRECISIONS):
        for colour, name in zip(("tab:blue", "tab:orange", "tab:green"), names, strict=True):
            some = [t for t in trials if (t.name, t.dtype) == (name, dtype)]
            x = [t.exponent for t in some]
            noticed = [top if t.tetrahedra is None else t.duplicates for t in some]
            axes[k].plot(x, noticed, "o-", color=colour, label=name, clip_on=False)
            there = [t for t in some if t.tetrahedra is not None]
            wrong = [t.wrong + t.flat for t in there]
            axes[k + 2].plot([t.exponent for t in there], wrong, "o-", color=colour, label=name)
            paper = TABLE3.get(name)
            if dtype == "float32" and paper is not None:
                axes[k].axhline(
                    top if paper == TOO_MANY else int(paper), color=colour, ls=":", label=f"{name}, paper"
                )
        axes[k].set(title=dtype, xlabel="log2 of eta", ylabel="duplicate faces and holes noticed")
        axes[k + 2].set(title=dtype, xlabel="log2 of eta", ylabel="wrong tetrahedra, exactly")
        _scale(axes[k], top, given_up=True)
        _scale(axes[k + 2], top, given_up=False)
        axes[k + 2].axvline(
            int(np.log2(MAGNITUDE[np.dtype(dtype)])), color="0.8", zorder=0, label="dt3d's default"
        )
    axes[1].legend()
    axes[2].legend()
    return figure


def _scale(ax: Axes, top: float, *, given_up: bool) -> None:
    """Counts from 0 on, in logarithms; too many are at the upper end."""
    ax.set_yscale("symlog", linthresh=1)
    ticks = [0, *(10**k for k in range(int(np.log10(top)) + 1) if 10**k < top / 2)]
    labels = list(map(str, ticks))
    if given_up:
        ticks, labels = [*ticks, int(top)], [*labels, TOO_MANY]
    ax.set_yticks(ticks, labels)
    ax.set_ylim(-0.2, 1.3 * top)

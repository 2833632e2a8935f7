"""How far to move sites: which eta, in which precision? Teng et al. 1993, section 5.1, do not say.

A perturbation that is small leaves ties of cospherical sites to rounding: the faces of one round contradict
each other, which the dictionary of dead faces notices as duplicates. One that is large gives the Delaunay
triangulation of other sites, which nothing notices. Both are counted here. A tetrahedron is wrong if a site
is strictly inside its circumsphere, by exact predicates on the sites as they came; of cospherical sites
several triangulations are right.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

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
LEAST, LARGEST = 40, 4  # eta is 2^-40 to 2^-4
AT_ONCE = 2**18  # in-sphere tests, to bound the memory


class Faults(NamedTuple):
    """What is not Delaunay, exactly.

    ``wrong`` tetrahedra have a site strictly inside their circumsphere, the deepest is ``deepest`` inside, in
    units of the greatest extent of the set; ``flat`` ones have no volume.
    """

    wrong: int
    flat: int
    deepest: float


NONE = Faults(0, 0, 0.0)


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
    faults : Faults
        What is not Delaunay about them, exactly.
    proven : bool
        Whether they are a Delaunay triangulation, by `dt3d.verification.verify`.
    """

    name: str
    dtype: str
    exponent: int
    tetrahedra: int | None
    duplicates: int
    faults: Faults = NONE
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


def faults(points: np.ndarray, simplices: np.ndarray, right: np.ndarray) -> Faults:
    """The faults of tetrahedra int (m, 4) of points (n, 3).

    Those among ``right``, int (k, 4), the simplices of an exact triangulation, are not looked at.
    """
    known = {tuple(row) for row in np.sort(right, axis=1)}
    rows = np.unique(np.sort(simplices, axis=1), axis=0)
    others = rows[[tuple(row) not in known for row in rows]]
    wrong, flat, deepest = 0, 0, 0.0
    for some in np.array_split(others, max(1, -(-len(others) * len(points) // AT_ONCE))):
        a, b, c, d = (points[some[:, k]] for k in range(4))
        sign = orient3d(a, b, c, d)
        side = in_sphere(a[:, None], b[:, None], c[:, None], d[:, None], points[None]) * sign[:, None]
        wrong += int((side > 0).any(axis=1).sum())
        flat += int((sign == 0).sum())
        for k in np.flatnonzero((side > 0).any(axis=1)):
            deepest = max(deepest, depth(points[some[k]], points[side[k] > 0]))
    return Faults(wrong, flat, deepest / float(np.ptp(points, axis=0).max()))


def depth(corners: np.ndarray, inside: np.ndarray) -> float:
    """How far the deepest of sites (k, 3) is inside the circumsphere of corners (4, 3); up to rounding."""
    a = [Fraction(float(x)) for x in corners[0]]
    edges, sites = (
        [[Fraction(float(x)) - y for x, y in zip(p, a, strict=True)] for p in some]
        for some in (corners[1:], inside)
    )
    squares = [_dot(e, e) for e in edges]
    normals = [_cross(edges[1], edges[2]), _cross(edges[2], edges[0]), _cross(edges[0], edges[1])]
    twice = 2 * _dot(edges[0], normals[0])
    centre = [
        sum((s * n[k] for s, n in zip(squares, normals, strict=True)), Fraction()) / twice for k in range(3)
    ]
    square = _dot(centre, centre)
    power = min(_dot(p, p) - 2 * _dot(p, centre) for p in sites)
    return float(-power) / (math.sqrt(square) + math.sqrt(square + power))


def _dot(a: list[Fraction], b: list[Fraction]) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


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
    proven = bool(verify(points, tri.simplices))
    found = faults(points, tri.simplices, right)
    return Trial(name, dtype, exponent, len(tri.simplices), tri.stats.inconsistencies, found, proven)


def eta(
    out: Path, console: Console, *, most_sites: int = 1000, step: int = 6, seed: int = SEED
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
    header += ["deepest_inside"]
    lines: list[list[object]] = []
    for t in trials:
        gone = t.tetrahedra is None
        rest = ["", t.duplicates, "", "", ""] if gone else [t.tetrahedra, t.duplicates, *t.faults]
        lines.append([t.name, t.dtype, t.exponent, t.ending, *rest])
    publish(console, out, "eta", header, lines, _draw(trials, names))
    return trials


def _table(trials: list[Trial], names: Sequence[str], console: Console) -> None:
    table = new_table(
        "Duplicate faces noticed / wrong tetrahedra / how far the deepest site is inside, by eta",
        ("eta",),
        (f"{name}, {dtype}" for dtype in PRECISIONS for name in names),
    )
    for exponent in sorted({t.exponent for t in trials}):
        cells = [
            _cell(t) for dtype in PRECISIONS for name in names for t in _of(trials, name, dtype, [exponent])
        ]
        table.add_row(f"2^{exponent}", *cells)
    table.add_section()
    table.add_row("paper, any", *("0" for _ in names), *(str(TABLE3.get(name, "-")) for name in names))
    table.show(console)


def _cell(trial: Trial) -> str:
    if trial.tetrahedra is None:
        return "given up"
    wrong, flat, deepest = trial.faults
    parts = [str(trial.duplicates), str(wrong) + (f" + {flat} flat" if flat else "")]
    return " / ".join([*parts, f"{deepest:.0e}"] if wrong else parts)


def _of(trials: Iterable[Trial], name: str, dtype: str, exponents: Sequence[int]) -> list[Trial]:
    return [t for t in trials if (t.name, t.dtype) == (name, dtype) and t.exponent in exponents]


def _conclude(trials: list[Trial], names: Sequence[str], console: Console) -> None:
    exponents = sorted({t.exponent for t in trials})
    for dtype in PRECISIONS:
        runs = [t for t in trials if t.dtype == dtype]
        quiet = [
            e for e in exponents if all(t.tetrahedra and not t.duplicates for t in runs if t.exponent == e)
        ]
        words = []
        for name in names:
            exact = [t.exponent for t in runs if t.name == name and t.proven]
            deepest = [t.faults.deepest for t in runs if t.name == name and t.exponent in quiet]
            depths = f" (the deepest site up to {max(deepest):.1g} inside otherwise)" if any(deepest) else ""
            words.append(f"{name} is Delaunay with {_powers(exact, exponents)}{depths}")
        console.print(
            f"{dtype}: no set has a duplicate face with eta {_powers(quiet, exponents)}. By exact predicates "
            f"{'; '.join(words)} (depths where no set has a duplicate). {sum(t.silent for t in runs)} of "
            f"{len(runs)} runs are wrong and do not say so. dt3d's default is 2^{_default(dtype)}."
        )
    paper = {name: str(TABLE3[name]) for name in names if name in TABLE3}
    near = {name: [t.exponent for t in _of(trials, name, "float32", exponents) if _like(t)] for name in paper}
    some = "; ".join(f"{name} ({paper[name]}): {_powers(near[name], exponents)}" for name in paper)
    common = set.intersection(*map(set, near.values())) if near else set()
    console.print(
        f"In single precision the paper's Table 3 is met, to a factor of two, with these eta: {some}. "
        f"With one eta for all: {_powers(sorted(common), exponents)}."
    )
    rounding = float(np.finfo(np.float32).eps) / 2
    console.print(
        "Wrong tetrahedra have a site strictly inside their circumsphere; how far is in units of the set's "
        f"extent, and single precision rounds the sites themselves, by up to {rounding:.0e} of it. The "
        "torus' circles are rounded to double precision: exactly, their sites are no longer cospherical, and "
        "a perturbation decides them anew. It does not show what the paper's eta was, nor what other "
        "matrices M give: each run has the same one. The paper's torus is not published: ours is of its kind "
        "only."
    )


def _like(trial: Trial) -> bool:
    """Whether a run ended as the paper's Table 3 has it: given up as there, or within a factor of two."""
    paper = TABLE3[trial.name]
    if paper == TOO_MANY or trial.tetrahedra is None:
        return paper == TOO_MANY and trial.tetrahedra is None
    return int(paper) / 2 <= trial.duplicates <= 2 * int(paper)


def _powers(exponents: Sequence[int], tried: Sequence[int]) -> str:
    """These exponents of all that were tried, in order; as a range if none between them is missing."""
    if len(exponents) > 2 and list(exponents) == [e for e in tried if exponents[0] <= e <= exponents[-1]]:
        return f"2^{exponents[0]} to 2^{exponents[-1]}"
    return ", ".join(f"2^{e}" for e in exponents) or "none"


def _default(dtype: str) -> int:
    """The exponent of the eta that dt3d takes if none is given."""
    return int(np.log2(MAGNITUDE[np.dtype(dtype)]))


def _draw(trials: list[Trial], names: Sequence[str]) -> Figure:
    figure, axes = panels(4, 4.5)
    finished = [t for t in trials if t.tetrahedra is not None]
    top = 4 * max(10, *(max(t.duplicates, t.faults.wrong) for t in finished))
    for k, dtype in enumerate(PRECISIONS):
        for colour, name in zip(("tab:blue", "tab:orange", "tab:green"), names, strict=True):
            some = [t for t in trials if (t.name, t.dtype) == (name, dtype)]
            x = [t.exponent for t in some]
            noticed = [top if t.tetrahedra is None else t.duplicates for t in some]
            axes[k].plot(x, noticed, "o-", color=colour, label=name, clip_on=False)
            there = [t for t in some if t.tetrahedra is not None]
            wrong = [t.faults.wrong + t.faults.flat for t in there]
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
        axes[k + 2].axvline(_default(dtype), color="0.8", zorder=0, label="dt3d's default")
    axes[1].legend(loc="center left")
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

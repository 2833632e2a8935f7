"""Figure 2 of Teng et al. 1993: time against n, with bucketing and by brute force, and where they cross.

And with bucketing on a CM-2, whose time grows more slowly than the sites as long as processors are idle.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

import scanvec as sv

from .._stats import Statistics
from .._topology import OUTWARD
from ..delaunay import Delaunay
from ..extrapolation import normalise
from ..extrapolation.points import Point
from ..extrapolation.signed_distance import Frame, frame, signed_distance
from . import calibration
from ._output import new_table, panels, print_model, publish
from .paper import BREAK_EVEN, CM2_PROCESSORS, PROCESSORS, RANDOM
from .runs import MAIN_LOOP, SEED, cm5, measure, points_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

OPERATIONS = (0.0, 2e-7, 5e-7, 1e-6, 2e-6)  # seconds of an operation on an element, tried
MOST_BY_BRUTE_FORCE = 2000  # sites; its time grows with their square


class Nearest(NamedTuple):
    """The best site so far of a face: on a machine a vector of them, for a function of `map` one."""

    distance: Any
    site: Any


def _examine(face: Frame, best: Nearest, site: Point[jax.Array], k: jax.Array) -> Nearest:
    distance = signed_distance(face, site)
    better = distance < best.distance
    return Nearest(jnp.where(better, distance, best.distance), jnp.where(better, k, best.site))


def exhaustive(machine: sv.Machine, sites: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The fourth vertex of each face by trying every site: int32 (m,), -1 where no site is above.

    Without cells, requests and warrants: each processor keeps its own faces, and the sites come one after the
    other to all of them.

    Parameters
    ----------
    machine : scanvec.Machine
        What searches.
    sites : float64 (n, 3)
        All that are tried.
    faces : int (m, 3)
        Oriented with the normal (b-a) x (c-a) towards the side that is searched.
    """
    a, b, c = (Point(*(machine.vector(x) for x in sites[faces[:, k]].T)) for k in range(3))
    frames = machine.map(frame, a, b, c)
    best = Nearest(machine.full(len(faces), np.inf, np.float64), machine.full(len(faces), -1, np.int32))
    for k, site in enumerate(sites):
        best = machine.map(_examine, frames, best, Point(*site), np.int32(k))
    return np.asarray(best.site.to_numpy())


@dataclass(frozen=True)
class Size:
    """One size of random sets: the main loop's ledgers with cells and, up to some size, without.

    ``cm2`` are the predicted seconds of the main loop on the paper's CM-2.
    """

    sites: int
    paper: float
    bucketing: sv.Ledger
    brute_force: sv.Ledger | None
    cm2: float


def cm2_seconds(n: int, seed: int = SEED) -> float:
    """Seconds of the main loop on a CM-2 of 16,384 processors, in single precision as in the paper."""
    machine = sv.Simulated(CM2_PROCESSORS, model=sv.CM2)
    seconds = measure(points_of(f"rand.{n}", seed), machine, np.float32).predicted
    assert seconds is not None  # the machine has a model
    return seconds


def growth(seconds: list[float], sites: list[int]) -> list[float]:
    """The slope between one size and the next, in logarithms: 1 where time grows as the sites."""
    return [float(x) for x in np.diff(np.log(seconds)) / np.diff(np.log(sites))]


def run(n: int, seed: int = SEED, *, brute_force: bool = True) -> Size:
    """Triangulate, and search all faces of every iteration again by brute force."""
    points = points_of(f"rand.{n}", seed)
    machine, left = cm5(), []
    tri = Delaunay(points, preset="teng1993", machine=machine, callback=lambda p: left.append(p.remaining))
    assert isinstance(tri.stats, Statistics)
    paper = next(row.seconds for row in RANDOM if row.sites == n)
    loop = machine.ledger.of(*MAIN_LOOP)
    if not brute_force:
        return Size(n, paper, loop, None, cm2_seconds(n, seed))
    slow = cm5()
    later = left[:-1]
    # which faces an iteration opens does not matter to the loads, their number does
    every = tri.simplices[:, OUTWARD[:, ::-1]].reshape(-1, 3)
    opposite = tri.simplices.reshape(-1)
    for count in [tri.stats.face_expansions - sum(later), *later]:
        chosen = np.arange(count) % len(every)
        with slow.phase("face expansion"):
            found = exhaustive(slow, normalise(points), every[chosen])
        assert np.array_equal(found, opposite[chosen])  # both searches answer alike
    # what happens to new tetrahedra is the same
    slow.ledger.entries += machine.ledger.of("dead faces").entries
    return Size(n, paper, loop, slow.ledger, cm2_seconds(n, seed))


def break_even(sizes: list[Size], model: sv.Model) -> float | None:
    """Sites at which both take equally long, by interpolation of the logarithms; None without a crossing."""
    both = [s for s in sizes if s.brute_force is not None]
    n = np.log([s.sites for s in both])
    gain = np.array([_ratio(s, model) for s in both])
    crossing = np.flatnonzero((gain[:-1] <= 0) & (gain[1:] > 0))
    if not len(crossing):
        return None
    k = crossing[0]
    return float(np.exp(n[k] + (n[k + 1] - n[k]) * -gain[k] / (gain[k + 1] - gain[k])))


def break_evens_without_a_row(sizes: list[Size]) -> list[float | None]:
    """The break-even if any one size is left out of the calibration; empty if too few would be left."""
    if len(sizes) <= calibration.FEWEST:
        return []
    out = []
    for left_out in sizes:
        kept = {f"rand.{s.sites}": s.bucketing for s in sizes if s is not left_out}
        out.append(break_even(sizes, calibration.calibrated(kept)))
    return out


def break_evens_by_cost(sizes: list[Size]) -> dict[float, float | None]:
    """The break-even if an operation on an element took so many seconds, the rest calibrated with that."""
    ledgers = {f"rand.{s.sites}": s.bucketing for s in sizes}
    return {
        cost: break_even(
            sizes, calibration.calibrated(ledgers, sv.CM5.calibrated("assumed, to see", element=cost))
        )
        for cost in OPERATIONS
    }


def _text(sites: float | None) -> str:
    return "none" if sites is None else f"{sites:.0f}"


def _ratio(size: Size, model: sv.Model) -> float:
    assert size.brute_force is not None
    return float(np.log(size.brute_force.under(model).seconds / size.bucketing.under(model).seconds))


def figure2(
    out: Path, console: Console, *, most_sites: int = 16000, seed: int = SEED
) -> tuple[list[Size], float | None]:
    """Teng et al. 1993, Figure 2: time by sites, CM-5 (bucketing, brute force) and CM-2; the break-even.

    Predicted by the CM-5 model, calibrated to the paper's times with bucketing, and by the CM-2 model, to
    which nothing is fitted. Writes ``figure2.csv``, ``figure2.png`` and ``figure2.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    sizes = []
    with console.status("...") as status:
        for row in RANDOM:
            if row.sites <= most_sites:
                status.update(f"{row.name} ...")
                sizes.append(run(row.sites, seed, brute_force=row.sites <= MOST_BY_BRUTE_FORCE))
    model = calibration.calibrated({f"rand.{s.sites}": s.bucketing for s in sizes})
    table = new_table(
        f"Teng et al. 1993, Figure 2: seconds, CM-5 of {PROCESSORS} nodes, CM-2 of {CM2_PROCESSORS:,}",
        (),
        ("sites", "bucketing, paper", "bucketing, model", "brute force, model", "CM-2, model", "CM-2, slope"),
    )
    lines: list[Line] = []
    slopes = [None, *growth([s.cm2 for s in sizes], [s.sites for s in sizes])]
    for s, slope in zip(sizes, slopes, strict=True):
        brute = None if s.brute_force is None else s.brute_force.under(model).seconds
        lines.append(Line(s.sites, s.paper, s.bucketing.under(model).seconds, brute, s.cm2))
        table.add_row(str(s.sites), *("" if x is None else f"{x:.2f}" for x in (*lines[-1][1:], slope)))
    table.show(console)
    print_model(console, model)
    crossing = break_even(sizes, model)
    text = "does not lie in this range" if crossing is None else f"is at {crossing:.0f} sites"
    console.print(f"The break-even {text}; paper: about {BREAK_EVEN}.")
    others = ", ".join(_text(n) for n in break_evens_without_a_row(sizes))
    if others:
        console.print(f"With any one row of Table 1 left out of the calibration it would be: {others}.")
    by_cost = break_evens_by_cost(sizes)
    console.print(
        "Brute force only computes, so that it hangs on what an operation on an element costs, which is an "
        "estimate, since Table 1 leaves it open: "
        + ", ".join(f"{_text(n)} with {1e6 * cost:g} us" for cost, n in by_cost.items())
        + "."
    )
    console.print(
        "The CM-2 computes in single precision, with the constants of scanvec.CM2. Its slope is that between "
        "a size and the one before; 1 is linear. The paper has its curve in a picture only, and says that it "
        "grows more slowly than the sites, since most sizes do not use the machine fully."
    )
    publish(console, out, "figure2", Line._fields, lines, _draw(lines, crossing))
    return sizes, crossing


class Line(NamedTuple):
    """A row of figure2.csv: one size of random sets."""

    sites: int
    paper_seconds: float
    model_seconds: float
    brute_force_seconds: float | None
    cm2_seconds: float


def _draw(lines: list[Line], crossing: float | None) -> Figure:
    figure, (ax,) = panels(1, 6.0)
    n = [line.sites for line in lines]
    ax.loglog(n, [line.paper_seconds for line in lines], "s--", label="CM-5, bucketing, paper")
    ax.loglog(n, [line.model_seconds for line in lines], "o-", label="CM-5, bucketing, model")
    slow = [(line.sites, seconds) for line in lines if (seconds := line.brute_force_seconds) is not None]
    ax.loglog(*zip(*slow, strict=True) if slow else ([], []), "^-", label="CM-5, brute force, model")
    ax.loglog(n, [line.cm2_seconds for line in lines], "v-", label="CM-2, bucketing, model")
    ax.loglog(n, [lines[0].paper_seconds * k / n[0] for k in n], ":", color="0.6", label="O(n)")
    ax.axvline(BREAK_EVEN, color="0.8", label="break-even, paper (about)")
    if crossing is not None:
        ax.axvline(crossing, color="0.4", linestyle="--", label="break-even, model")
    ax.set(xlabel="sites", ylabel="seconds")
    ax.set_xticks(n, [str(k) for k in n], rotation=30)
    ax.minorticks_off()
    ax.legend(fontsize=8)
    return figure

"""Are the cells that a search opens in vain bounded by a constant times those that it needs?

Teng et al. 1993, section 6, expect so: R. A. Dwyer's sequential search opens the cells that meet the
circumsphere of the tetrahedron found and the face's positive half-space, in an order kept by a queue; theirs
opens "all cells in the containment box" of these. Here the faces that a run expands are recorded, and each
cell is counted: those that are needed in Dwyer's sense, computed from the tetrahedra found, and those that
the two rules of the search open for the same faces in the same grid.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import scanvec as sv

from ...extrapolation import Perturbed, extrapolate, normalise, perturb
from ...extrapolation.boxes import HostGrid
from ...extrapolation.buckets import Buckets
from ...extrapolation.expansion import PERTURBED, PerturbedFace, expand_perturbed
from ...extrapolation.faces import Face
from ...extrapolation.outcome import Counts
from ...extrapolation.search_options import PAPER_SEARCH, SearchOptions
from ...extrapolation.warrants import NO_SITE, SearchSpec
from ...extrapolation.whole_boxes import WHOLE_BOXES
from .._output import new_table, panels, publish
from ..paper import RANDOM
from ..runs import SEED, points_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

PAPER_CELLS = 10  # opened per face expansion, about (section 7)
ROUNDS = 2  # after which most are completed (section 7)
FEWEST_SITES = 1000
PAIRS_AT_ONCE = 2**20  # of a face and a cell of its sphere's box, to bound the memory

RULES: dict[str, tuple[SearchOptions, SearchSpec[PerturbedFace]]] = {
    "boxes": (PAPER_SEARCH, WHOLE_BOXES),  # the paper's
    "caps": (SearchOptions(uniform_cells=True), PERTURBED),
}


class Expanded(NamedTuple):
    """Faces that were expanded, by sites in the order of the buckets."""

    faces: np.ndarray  # int32 (m, 3)
    fourth: np.ndarray  # int32 (m,): the vertex found, `NO_SITE` above the hull


class _Recorded(Perturbed):
    """Expands faces as `Perturbed` does, and keeps them."""

    def __init__(self, buckets: Buckets, kept: list[Expanded], buckets_kept: list[Buckets]) -> None:
        super().__init__(buckets)
        self._kept = kept
        buckets_kept.append(buckets)

    def expand(self, faces: Face[sv.Vector]) -> tuple[sv.Vector, Counts]:
        """The fourth vertex of each face, or `NO_SITE`."""
        site, counts = super().expand(faces)
        self._kept.append(Expanded(np.stack([v.to_numpy() for v in faces], axis=1), site.to_numpy()))
        return site, counts


def expanded_faces(points: np.ndarray) -> tuple[Buckets, Expanded]:
    """The faces that the paper's method expands for points (n, 3), in uniform cells."""
    sites = perturb(normalise(points), np.dtype(np.float64), seed=0)
    kept: list[Expanded] = []
    buckets: list[Buckets] = []
    mode = partial(_Recorded, kept=kept, buckets_kept=buckets)
    extrapolate(sv.Device(), sites, mode, options=RULES["caps"][0])
    return buckets[0], Expanded(*(np.concatenate(columns) for columns in zip(*kept, strict=True)))


class Needed(NamedTuple):
    """Cells of each face with a tetrahedron, int64 (m,)."""

    cap: np.ndarray  # that meet the tetrahedron's circumsphere and the face's positive half-space
    box: np.ndarray  # of the containment box of these
    sphere: np.ndarray  # of the containment box of the circumsphere


def needed(corners: np.ndarray, grid: HostGrid) -> Needed:
    """Cells of the grid that the search of a face cannot do without.

    Parameters
    ----------
    corners : float64 (m, 4, 3)
        Of tetrahedra with positive volumes; the face is that of the first three.
    grid : Grid
        The uniform cells.
    """
    low, shape = np.array(grid.origin, float), np.array([grid.nx, grid.ny, grid.nz])
    edges = corners[:, 1:] - corners[:, :1]
    centre = corners[:, 0] + np.linalg.solve(edges, (edges**2).sum(axis=2)[..., None] / 2)[..., 0]
    radius = np.linalg.norm(centre - corners[:, 0], axis=1)
    first, last = (
        np.clip((centre + sign * radius[:, None] - low) // grid.side, 0, shape - 1).astype(int)
        for sign in (-1, 1)
    )
    sphere = np.prod(last - first + 1, axis=1)
    parts = np.array_split(np.arange(len(corners)), max(1, -(-int(sphere.sum()) // PAIRS_AT_ONCE)))
    counts = [
        _cap(
            corners[p, 0], np.cross(edges[p, 0], edges[p, 1]), centre[p], radius[p], (first[p], last[p]), grid
        )
        for p in parts
    ]
    cap, box = (np.concatenate(column) for column in zip(*counts, strict=True))
    return Needed(cap, box, sphere)


def _cap(
    origin: np.ndarray,
    normal: np.ndarray,
    centre: np.ndarray,
    radius: np.ndarray,
    box: tuple[np.ndarray, np.ndarray],
    grid: HostGrid,
) -> tuple[np.ndarray, np.ndarray]:
    """How many cells of each sphere's box meet the sphere and the half-space; and those of their box."""
    first, last = box
    width = last - first + 1
    count = np.prod(width, axis=1)
    face = np.repeat(np.arange(len(first)), count)
    k = np.arange(len(face)) - np.repeat(np.cumsum(count) - count, count)
    i, rest = k % width[face, 0], k // width[face, 0]
    cell = first[face] + np.stack([i, rest % width[face, 1], rest // width[face, 1]], axis=1)
    corner = np.array(grid.origin, float) + cell * grid.side
    gap = np.maximum(np.maximum(corner - centre[face], centre[face] - corner - grid.side), 0)
    highest = ((corner - origin[face]) * normal[face]).sum(axis=1)
    highest += grid.side * np.maximum(normal, 0).sum(axis=1)[face]
    # the vertex that was found is on the sphere, up to rounding
    meets = ((gap**2).sum(axis=1) <= radius[face] ** 2 * (1 + 1e-9)) & (highest >= 0)
    face, cell = face[meets], cell[meets]
    starts = np.searchsorted(face, np.arange(len(first)))
    extent = np.maximum.reduceat(cell, starts) - np.minimum.reduceat(cell, starts) + 1
    return np.bincount(face, minlength=len(first)), np.prod(extent, axis=1)


class Opened(NamedTuple):
    """What a rule did for some faces."""

    cells: int
    sites: int
    rounds: tuple[int, ...]  # how many faces took 1, 2, ... rounds


def opened(buckets: Buckets, faces: np.ndarray, rule: str) -> Opened:
    """Search for faces int (m, 3) by a rule of `RULES`."""
    options, spec = RULES[rule]
    vectors = (buckets.machine.vector(np.ascontiguousarray(v)) for v in faces.T)
    result = expand_perturbed(replace(buckets, options=options), Face(*vectors), spec)
    return Opened(result.cells_opened, result.sites_searched, result.rounds)


@dataclass(frozen=True)
class Size:
    """One random set.

    Attributes
    ----------
    sites, expansions, hull : int
        Sites, faces expanded, and those of them that are of the hull.
    needed : tuple of float
        `Needed`, on average over faces with a tetrahedron.
    with_tetrahedron, above_hull : dict of str to Opened
        By rule, for faces with a tetrahedron and for those of the hull.
    """

    sites: int
    expansions: int
    hull: int
    needed: tuple[float, float, float]
    with_tetrahedron: dict[str, Opened]
    above_hull: dict[str, Opened]

    def cells(self, rule: str) -> float:
        """Cells opened per face with a tetrahedron."""
        return self.with_tetrahedron[rule].cells / (self.expansions - self.hull)

    def ratio(self, rule: str) -> float:
        """Cells opened over cells needed."""
        return self.cells(rule) / self.needed[0]

    def all_cells(self, rule: str) -> float:
        """Cells opened per face expansion."""
        return (self.with_tetrahedron[rule].cells + self.above_hull[rule].cells) / self.expansions

    def soon(self, rule: str) -> float:
        """The share of face expansions that the first two rounds complete."""
        both = self.with_tetrahedron[rule].rounds, self.above_hull[rule].rounds
        return sum(sum(rounds[:ROUNDS]) for rounds in both) / self.expansions


class Group(NamedTuple):
    """Faces that need ``least`` to twice as many cells, less one; cells needed and opened by all of them."""

    least: int
    faces: int
    needed: int
    opened: dict[str, int]


def measure(points: np.ndarray, *, groups: bool = False) -> tuple[Size, list[Group]]:
    """Count the cells of one set of points (n, 3); and of groups of its faces, if they are asked for."""
    buckets, found = expanded_faces(points)
    assert buckets.cells is not None
    hull = found.fourth == NO_SITE
    faces, fourth = found.faces[~hull], found.fourth[~hull]
    coordinates = np.stack([v.to_numpy() for v in buckets.sites], axis=1)
    cells = needed(coordinates[np.column_stack([faces, fourth])], buckets.cells.grid)
    size = Size(
        len(points),
        len(hull),
        int(hull.sum()),
        (float(cells.cap.mean()), float(cells.box.mean()), float(cells.sphere.mean())),
        {rule: opened(buckets, faces, rule) for rule in RULES},
        {rule: opened(buckets, found.faces[hull], rule) for rule in RULES},
    )
    if not groups:
        return size, []
    power = np.log2(cells.cap).astype(int)
    out = []
    for k in np.unique(power):
        some = power == k
        by_rule = {rule: opened(buckets, faces[some], rule).cells for rule in RULES}
        out.append(Group(2 ** int(k), int(some.sum()), int(cells.cap[some].sum()), by_rule))
    return size, out


def cells(
    out: Path, console: Console, *, most_sites: int = 16000, seed: int = SEED
) -> tuple[list[Size], list[Group]]:
    """Teng et al. 1993, section 6: are extra cells over needed ones bounded? Cells opened and needed, rounds.

    For random sets by the search's rule: the paper's boxes, and caps. Writes ``cells.csv``, ``cells.png`` and
    ``cells.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    sizes: list[Size] = []
    groups: list[Group] = []
    rows = [row for row in RANDOM if min(FEWEST_SITES, most_sites) <= row.sites <= most_sites]
    with console.status("...") as status:
        for row in rows:
            status.update(f"{row.name} ...")
            size, groups = measure(points_of(row.name, seed), groups=row is rows[-1])
            sizes.append(size)
    _table(sizes, console)
    _group_table(sizes[-1], groups, console)
    _conclude(sizes, groups, console)
    header = ["sites", "faces", "least_needed", "face_expansions", "needed", "box_of_needed", "box_of_sphere"]
    header += [f"{rule}_{what}" for rule in RULES for what in ("opened", "over_needed", "two_rounds")]
    lines: list[list[object]] = []
    for s in sizes:
        ours = [x for rule in RULES for x in (s.cells(rule), s.ratio(rule), s.soon(rule))]
        lines.append([s.sites, "with a tetrahedron", "", s.expansions - s.hull, *s.needed, *ours])
        above: list[object] = []
        for rule in RULES:
            above += [s.above_hull[rule].cells / max(s.hull, 1), "", ""]
        lines.append([s.sites, "hull", "", s.hull, "", "", "", *above])
    for g in groups:
        of: list[object] = []
        for rule in RULES:
            of += [g.opened[rule] / g.faces, g.opened[rule] / g.needed, ""]
        lines.append([sizes[-1].sites, "group", g.least, g.faces, g.needed / g.faces, "", "", *of])
    publish(console, out, "cells", header, lines, _draw(sizes, groups))
    return sizes, groups


def _table(sizes: list[Size], console: Console) -> None:
    table = new_table(
        "Cells per face expansion: needed, and opened by the paper's boxes and by caps",
        ("sites",),
        (
            *("FE", "needed", "their box", "sphere's box"),
            *(
                f"{rule}, {what}"
                for rule in RULES
                for what in ("opened", "/ needed", "/ sphere's", "all FE", "hull FE")
            ),
            *(f"{rule}, 2 rounds %" for rule in RULES),
        ),
    )
    for s in sizes:
        row = [f"{s.expansions}", *(f"{x:.2f}" for x in s.needed)]
        for rule in RULES:
            row += [f"{s.cells(rule):.2f}", f"{s.ratio(rule):.2f}", f"{s.cells(rule) / s.needed[2]:.2f}"]
            row += [f"{s.all_cells(rule):.2f}", f"{s.above_hull[rule].cells / max(s.hull, 1):.1f}"]
        table.add_row(str(s.sites), *row, *(f"{100 * s.soon(rule):.1f}" for rule in RULES))
    table.show(console)


def _group_table(size: Size, groups: list[Group], console: Console) -> None:
    table = new_table(
        f"{size.sites} sites: opened over needed, by the cells that a face needs",
        ("needed",),
        ("FE", "mean", *RULES),
    )
    for g in groups:
        ratios = (f"{g.opened[rule] / g.needed:.2f}" for rule in RULES)
        range_ = f"{g.least} to {2 * g.least - 1}" if g.least > 1 else "1"
        table.add_row(range_, str(g.faces), f"{g.needed / g.faces:.1f}", *ratios)
    table.show(console)


def _conclude(sizes: list[Size], groups: list[Group], console: Console) -> None:
    first, last = sizes[0], sizes[-1]
    for rule in RULES:
        ratios = [g.opened[rule] / g.needed for g in groups]
        console.print(
            f"{rule}: opened over needed is {first.ratio(rule):.2f} at {first.sites} sites and "
            f"{last.ratio(rule):.2f} at {last.sites}; by cells needed it is between {min(ratios):.2f} and "
            f"{max(ratios):.2f} at the latter. There {last.all_cells(rule):.1f} cells are opened per face "
            f"expansion, those of the hull included (paper: about {PAPER_CELLS}), and "
            f"{100 * last.soon(rule):.0f} % are completed by {ROUNDS} rounds (paper: most)."
        )
    console.print(
        "FE: face expansions. Columns are of those that find a tetrahedron, but where they say all or hull. "
        "Needed: cells that meet its circumsphere and the half-space. Their box is what the paper says that "
        "it opens. The paper's 10 is its search/FE over 8 sites per cell. Random sets of some sizes show a "
        "trend, not a bound; clusters are not tried. Both rules have the paper's cube of cells here, and "
        "caps opens cells without searching those that cannot hold a better site."
    )


def _draw(sizes: list[Size], groups: Sequence[Group]) -> Figure:
    figure, axes = panels(2, 4.5)
    n = [s.sites for s in sizes]
    for rule, marker in zip(RULES, "so", strict=True):
        axes[0].plot(n, [s.cells(rule) for s in sizes], f"{marker}-", label=f"opened, {rule}")
    for k, name in enumerate(("needed: cap", "box of these", "sphere's box")):
        axes[0].plot(n, [s.needed[k] for s in sizes], "^:", label=name)
    axes[0].axhline(PAPER_CELLS, color="0.6", ls="--", label="paper, about, all faces")
    axes[0].set(xlabel="sites", ylabel="cells per face expansion", xscale="log")
    axes[0].set_xticks(n, [str(k) for k in n])
    axes[0].minorticks_off()
    axes[0].set_ylim(bottom=0)
    for rule, marker in zip(RULES, "so", strict=True):
        mean = [g.needed / g.faces for g in groups]
        axes[1].plot(mean, [g.opened[rule] / g.needed for g in groups], f"{marker}-", label=rule)
    axes[1].axhline(1, color="0.6", ls=":", label="no cell in vain")
    axes[1].set(xlabel="cells that a face needs", ylabel="cells opened / needed", xscale="log")
    axes[1].set_ylim(bottom=0)
    for ax in axes:
        ax.legend()
    return figure

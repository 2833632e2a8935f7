"""Are the cells that a search opens in vain bounded by a constant times those that it needs?

Teng et al. 1993, section 6, expect so: R. A. Dwyer's sequential search opens the cells that meet the
circumsphere of the tetrahedron found and the face's positive half-space, in an order kept by a queue; theirs
opens "all cells in the containment box" of these. Here the faces that a run expands are recorded, and each
cell is counted: those that are needed in Dwyer's sense, computed from the tetrahedra found, and those that
the two rules of the search open for the same faces in the same grid. Spheres that reach out of the sites' box
are told from those within it, as they alone can be larger and larger.
"""

from __future__ import annotations

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
    """Cells of each face with a tetrahedron, int64 (m,); and bool (m,)."""

    cap: np.ndarray  # that meet the tetrahedron's circumsphere and the face's positive half-space
    box: np.ndarray  # of the containment box of these
    sphere: np.ndarray  # of the containment box of the circumsphere
    inner: np.ndarray  # whether the circumsphere is within the box of all sites


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
    reach = radius[:, None]
    inner = (centre - reach >= np.array(grid.origin)) & (centre + reach <= np.array(grid.high))
    return Needed(cap, box, sphere, inner.all(axis=1))


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
class Part:
    """Some of the faces that were expanded.

    Attributes
    ----------
    faces : int
        How many.
    cap, box, sphere : float
        `Needed`, on average; not a number for those of the hull.
    opened : dict of str to Opened
        By rule.
    """

    faces: int
    cap: float
    box: float
    sphere: float
    opened: dict[str, Opened]

    def cells(self, rule: str) -> float:
        """Cells opened per face."""
        return self.opened[rule].cells / self.faces

    def ratio(self, rule: str) -> float:
        """Cells opened over cells needed."""
        return self.cells(rule) / self.cap


@dataclass(frozen=True)
class Size:
    """One set: the faces that were expanded, by where their spheres are.

    Attributes
    ----------
    sites : int
        How many.
    inner, rim : Part
        Faces whose tetrahedron has its circumsphere within the sites' box, and the others with a tetrahedron.
    hull : Part
        Those without one.
    """

    sites: int
    inner: Part
    rim: Part
    hull: Part

    @property
    def parts(self) -> dict[str, Part]:
        """All of them, by name."""
        return {"inner": self.inner, "rim": self.rim, "hull": self.hull}

    @property
    def expansions(self) -> int:
        """Faces expanded."""
        return sum(part.faces for part in self.parts.values())

    def cells(self, rule: str) -> float:
        """Cells opened per face expansion."""
        return sum(part.opened[rule].cells for part in self.parts.values()) / self.expansions

    def searched(self, rule: str) -> float:
        """Sites searched per face expansion."""
        return sum(part.opened[rule].sites for part in self.parts.values()) / self.expansions

    def soon(self, rule: str) -> float:
        """The share of face expansions that the first two rounds complete."""
        return sum(sum(part.opened[rule].rounds[:ROUNDS]) for part in self.parts.values()) / self.expansions

    def ratio(self, rule: str) -> float:
        """Cells opened over cells needed, of all faces with a tetrahedron."""
        both = self.inner, self.rim
        return sum(p.opened[rule].cells for p in both) / sum(p.cap * p.faces for p in both)


def measure(points: np.ndarray) -> Size:
    """Count the cells of one set of points (n, 3)."""
    buckets, found = expanded_faces(points)
    assert buckets.cells is not None
    some = found.fourth != NO_SITE
    coordinates = np.stack([v.to_numpy() for v in buckets.sites], axis=1)
    cells = needed(coordinates[np.column_stack(found)[some]], buckets.cells.grid)
    inner = np.zeros(len(some), bool)
    inner[some] = cells.inner

    def part(chosen: np.ndarray) -> Part:
        counts = (count[chosen[some]] for count in cells[:3])
        cap, box, sphere = (float(count.mean()) if len(count) else np.nan for count in counts)
        by_rule = {rule: opened(buckets, found.faces[chosen], rule) for rule in RULES}
        return Part(int(chosen.sum()), cap, box, sphere, by_rule)

    return Size(len(points), part(inner), part(some & ~inner), part(~some))


def cells(out: Path, console: Console, *, most_sites: int = 8000, seed: int = SEED) -> list[Size]:
    """Teng et al. 1993, section 6: are extra cells over needed ones bounded? Cells opened and needed, rounds.

    For random sets by the search's rule: the paper's boxes, and caps. Writes ``cells.csv``, ``cells.png`` and
    ``cells.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    sizes: list[Size] = []
    with console.status("...") as status:
        for row in RANDOM:
            if min(FEWEST_SITES, most_sites) <= row.sites <= most_sites:
                status.update(f"{row.name} ...")
                sizes.append(measure(points_of(row.name, seed)))
    _table(sizes, console)
    _conclude(sizes, console)
    header = [
        "sites",
        "spheres",
        "rule",
        "face_expansions",
        "needed",
        "box_of_needed",
        "box_of_sphere",
        "opened",
    ]
    header += ["over_needed", "sites_searched", "rounds_1", "rounds_2", "rounds_more"]
    lines: list[list[object]] = []
    for s in sizes:
        for name, part in s.parts.items():
            for rule, done in part.opened.items():
                means = ["" if np.isnan(x) else x for x in (part.cap, part.box, part.sphere)]
                ratio = "" if np.isnan(part.cap) else part.ratio(rule)
                rounds = [sum(done.rounds[:1]), sum(done.rounds[1:2]), sum(done.rounds[2:])]
                per_face = done.sites / part.faces
                lines.append(
                    [s.sites, name, rule, part.faces, *means, part.cells(rule), ratio, per_face, *rounds]
                )
    publish(console, out, "cells", header, lines, _draw(sizes))
    return sizes


def _table(sizes: list[Size], console: Console) -> None:
    table = new_table(
        "Cells per face expansion: needed and opened; inner spheres are within the box of all sites",
        ("sites", "rule"),
        (
            *("inner: needed", "their box", "opened", "/ needed"),
            *("rim, %", "rim: needed", "their box ", "opened ", "/ needed "),
            *("hull, %", "hull: opened", "all: opened", "2 rounds, %"),
        ),
    )
    for s in sizes:
        for rule in RULES:
            row = [str(s.sites), rule]
            for part in (s.inner, s.rim):
                if part is s.rim:
                    row.append(f"{100 * part.faces / s.expansions:.1f}")
                row += [f"{x:.2f}" for x in (part.cap, part.box, part.cells(rule), part.ratio(rule))]
            row += [f"{100 * s.hull.faces / s.expansions:.1f}", f"{s.hull.cells(rule):.1f}"]
            table.add_row(*row, f"{s.cells(rule):.2f}", f"{100 * s.soon(rule):.1f}")
    table.show(console)


def _conclude(sizes: list[Size], console: Console) -> None:
    first, last = sizes[0], sizes[-1]
    for rule in RULES:
        console.print(
            f"{rule}: from {first.sites} to {last.sites} sites, opened over needed goes from "
            f"{first.inner.ratio(rule):.2f} to {last.inner.ratio(rule):.2f} where the sphere is within the "
            f"box of all sites, from {first.rim.ratio(rule):.2f} to {last.rim.ratio(rule):.2f} where it "
            f"reaches out, and from {first.ratio(rule):.2f} to {last.ratio(rule):.2f} for both. In the "
            f"largest set {last.cells(rule):.1f} cells are opened per face expansion of all (paper: about "
            f"{PAPER_CELLS}), and {100 * last.soon(rule):.0f} % are completed by {ROUNDS} rounds (paper: "
            "most)."
        )
    boxes = [(part.box / part.cap) for s in sizes for part in (s.inner, s.rim)]
    console.print(
        f"The containment box of the needed cells, which the paper says that it opens, has {min(boxes):.2f} "
        f"to {max(boxes):.2f} times as many cells as are needed, inside and at the rim."
    )
    console.print(
        "Needed: cells that meet the circumsphere of the tetrahedron found and the face's half-space. Faces "
        "of the hull find none. The paper's 10 is its search/FE over 8 sites per cell. Random sets of some "
        "sizes show a trend, not a bound; clusters are not tried. Both rules have the paper's cube of cells "
        "here, and caps opens cells without searching those that cannot hold a better site."
    )


def _draw(sizes: list[Size]) -> Figure:
    figure, axes = panels(2, 4.5)
    n = [s.sites for s in sizes]
    for rule, marker in zip(RULES, "so", strict=True):
        axes[0].plot(n, [s.cells(rule) for s in sizes], f"{marker}-", label=f"opened, {rule}, all faces")
        for name, style in (("inner", "-"), ("rim", "--")):
            ratios = [s.parts[name].ratio(rule) for s in sizes]
            axes[1].plot(n, ratios, f"{marker}{style}", label=f"{rule}, {name} spheres")
    axes[0].plot(n, [s.inner.cap for s in sizes], "^:", label="needed, inner spheres")
    axes[0].plot(n, [s.rim.cap for s in sizes], "v:", label="needed, rim spheres")
    axes[0].axhline(PAPER_CELLS, color="0.6", ls="--", label="paper, about, all faces")
    axes[1].axhline(1, color="0.6", ls=":", label="no cell in vain")
    axes[0].set(xlabel="sites", ylabel="cells per face expansion")
    axes[1].set(xlabel="sites", ylabel="cells opened / needed")
    for ax in axes:
        ax.set_xscale("log")
        ax.set_xticks(n, [str(k) for k in n])
        ax.minorticks_off()
        ax.set_ylim(bottom=0)
        ax.legend(loc="lower left")
    return figure

"""What requests and warrants are for: the load of processors with them and without. Not in the paper.

Teng et al. 1993, section 4.2, names two imbalances: faces search different numbers of cells, and cells hold
different numbers of sites. Here all face expansions of a triangulation search at once, each the uniform cells
that meet its empty sphere on its positive side: what any search through these cells has to open. Three
ways to share that out are compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import scanvec as sv
import scanvec.plot

from .._stats import Statistics
from ..delaunay import Delaunay
from . import sets
from ._output import new_table, panels, publish
from .paper import PROCESSORS
from .runs import MAIN_LOOP, SEED, cm5

if TYPE_CHECKING:
    from rich.console import Console

SITES_PER_CELL = 8  # the paper's average (section 7)
SITES_PER_WARRANT = 8  # its number of sites in a cell, on average (section 4.2)
SCHEMES = ("requests and warrants", "requests only", "neither")


@dataclass(frozen=True)
class Work:
    """What the face expansions search: pairs of face and cell, in the order of the faces.

    Attributes
    ----------
    face : int array (r,)
        The face of each request.
    sites : int array (r,)
        Sites in its cell.
    faces : int
        How many faces there are.
    """

    face: np.ndarray
    sites: np.ndarray
    faces: int

    def items(self, scheme: str) -> np.ndarray:
        """Sites that each virtual processor searches under a scheme."""
        if scheme == "neither":
            return np.bincount(self.face, self.sites, self.faces).astype(np.int64)
        if scheme == "requests only":
            return self.sites
        warrants = -(-self.sites // SITES_PER_WARRANT)
        full = np.full(warrants.sum(), SITES_PER_WARRANT)
        last = np.cumsum(warrants)[warrants > 0] - 1
        full[last] = (self.sites - (warrants - 1) * SITES_PER_WARRANT)[warrants > 0]
        return full


@dataclass(frozen=True)
class Share:
    """How a scheme loads processors: sites searched by each, and in lock-step."""

    scheme: str
    loads: np.ndarray  # int (P,)
    lock_step: int  # VP ratio times the most sites of any virtual processor

    @property
    def busiest(self) -> float:
        """The busiest processor's load, where each runs by itself, over the mean."""
        return float(self.loads.max() / self.loads.mean())

    @property
    def in_step(self) -> float:
        """Time over the mean load, where all wait for the slowest virtual processor in every step."""
        return float(self.lock_step / self.loads.mean())


def work(points: np.ndarray, simplices: np.ndarray) -> Work:
    """The requests of one face expansion for each tetrahedron: that of the facet before its last vertex."""
    low, high = points.min(axis=0), points.max(axis=0)
    side = (np.prod(high - low) * SITES_PER_CELL / len(points)) ** (1 / 3)
    shape = np.maximum(np.ceil((high - low) / side), 1).astype(int)
    cells = np.minimum(((points - low) / side).astype(int), shape - 1)
    counts = np.bincount(np.ravel_multi_index(cells.T, shape), minlength=int(np.prod(shape)))

    a, b, c, d = (points[simplices[:, k]] for k in range(4))
    edges = np.stack([b - a, c - a, d - a], axis=1)
    centre = a + np.linalg.solve(edges, (edges**2).sum(axis=2)[..., None] / 2)[..., 0]
    radius = np.linalg.norm(centre - a, axis=1)
    normal = np.cross(b - a, c - a)
    found = [_cells_of(*ball, low, side, shape) for ball in zip(a, centre, radius, normal, strict=True)]
    face = np.concatenate([np.full(len(f), k) for k, f in enumerate(found)])
    return Work(face, counts[np.concatenate(found)], len(simplices))


def _cells_of(
    a: np.ndarray,
    centre: np.ndarray,
    radius: float,
    normal: np.ndarray,
    low: np.ndarray,
    side: float,
    shape: np.ndarray,
) -> np.ndarray:
    """Numbers of the cells that meet a ball and the half-space above a face."""
    first = np.clip((centre - radius - low) // side, 0, shape - 1).astype(int)
    last = np.clip((centre + radius - low) // side, 0, shape - 1).astype(int)
    axes = [np.arange(f, e + 1) for f, e in zip(first, last, strict=True)]
    index = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    corner = low + index * side
    gap = np.maximum(np.maximum(corner - centre, centre - corner - side), 0)
    highest = ((corner - a) * normal).sum(axis=1) + side * np.maximum(normal, 0).sum()
    meets = ((gap**2).sum(axis=1) <= radius**2) & (highest >= 0)
    return np.asarray(np.ravel_multi_index(tuple(index[meets].T), tuple(shape)))


def shares(todo: Work, processors: int = PROCESSORS) -> list[Share]:
    """The load of each processor under each scheme, virtual processors in blocks."""
    out = []
    for scheme in SCHEMES:
        items = todo.items(scheme)
        vp = -(-len(items) // processors)
        padded = np.zeros(vp * processors, np.int64)
        padded[: len(items)] = items
        out.append(Share(scheme, padded.reshape(processors, vp).sum(axis=1), int(vp * items.max())))
    return out


def balance(
    out: Path, console: Console, *, sites: int = 4000, seed: int = SEED
) -> dict[str, tuple[list[Share], float]]:
    """Not in the paper: load of 32 processors with and without requests and warrants, for two sets.

    One set is uniform, one of clusters. Also what the search as published examines.
    Writes ``balance.csv``, ``balance.png`` and ``balance.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    figure, axes = panels(4, 4.5)
    table = new_table(
        f"{sites} sites, uniform cells, {PROCESSORS} processors: time over that of perfect balance",
        ("sites", "scheme"),
        ("each by itself", "in lock-step", "sites per expansion"),
    )
    result, lines, examined = {}, [], {}
    for k, (name, points) in enumerate(
        {"uniform": sets.rand(sites, seed), "clusters": sets.clusters(sites, seed)}.items()
    ):
        with console.status(f"{name} ..."):
            machine = cm5()
            tri = Delaunay(points, preset="teng1993", machine=machine)
            todo = work(points, tri.simplices)
        assert isinstance(tri.stats, Statistics)
        examined[name] = tri.stats.sites_searched / tri.stats.face_expansions
        found = shares(todo)
        result[name] = found, examined[name]
        for share in found:
            mean = todo.sites.sum() / todo.faces
            table.add_row(name, share.scheme, f"{share.busiest:.2f}", f"{share.in_step:.2f}", f"{mean:.1f}")
            lines.append([name, share.scheme, share.busiest, share.in_step, mean])
            axes[k].step(range(PROCESSORS), share.loads / share.loads.mean(), where="mid", label=share.scheme)
        axes[k].set(title=f"{name}, uniform cells", xlabel="processor", ylabel="sites searched / mean")
        axes[k].set_ylim(bottom=0)
        sv.plot.load_balance(machine.ledger.of(*MAIN_LOOP), ax=axes[k + 2])
        axes[k + 2].set_title(f"{name}, the main loop as run")
    axes[0].legend(fontsize=8)
    table.show(console)
    for name, searched in examined.items():
        console.print(f"{name}: the search itself examined {searched:.1f} sites per expansion.")
    console.print(
        "Requests and warrants share out the sites of uniform cells evenly also where sites cluster; "
        "what they cannot mend is the work itself, since a few cells hold most sites. Without the preset the "
        "search takes a tree of boxes where cells fill unevenly."
    )
    header = ["sites", "scheme", "busiest", "lock_step", "sites_an_expansion"]
    publish(console, out, "balance", header, lines, figure)
    return result

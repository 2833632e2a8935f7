"""Figure 13: the Crater Lake terrain."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..._numba.cores import available_cores
from ...samples import crater_lake
from ...threaded2d import Delaunay
from .report import Row, publish
from .speedups import NOTE, SpeedupSet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

# speed-ups on a P 410 (2) and a PE 6400 (4), for 100,001 points of the terrain
PAPER = {"batch": (2.01, 4.40), "circumcircle": (2.00, 4.09)}


def crater(
    out: Path, console: Console, *, points: int = 100_001, repeats: int = 3, seed: int = 0
) -> list[Row]:
    """Figure 13: the Crater Lake terrain, speed-ups and a picture of it, coloured by height and by thread."""
    sites = crater_lake()
    if points < len(sites):
        sites = sites[np.sort(np.random.default_rng(seed).permutation(len(sites))[:points])]
    given = SpeedupSet(sites[:, :2], repeats)
    rows: list[Row] = []
    for method, (two, four) in PAPER.items():
        rows.append({"method": method, "paper 2": two, "paper 4": four} | given.row(method))
    tri = Delaunay(sites[:, :2], method="circumcircle", threads=4, subdivision="x-slabs")

    def draw(axes: Axes) -> None:
        corners = sites[tri.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / [30, 30, 1]
        light = normals @ [-0.5, 0.5, 0.7] / np.linalg.norm(normals, axis=1)
        x, y = tri.points.T
        axes.tripcolor(x, y, tri.triangles, facecolors=light, cmap="gray", rasterized=True)
        axes.tripcolor(
            x, y, tri.triangles, facecolors=tri.thread, cmap="tab10", vmax=9, alpha=0.3, rasterized=True
        )
        axes.set_aspect("equal")
        axes.set_title(f"{len(sites):,} points of Crater Lake; colours: the thread that made the triangle")

    note = f"{len(sites):,} points of the terrain. " + NOTE.format(
        processors=available_cores(), repeats=repeats
    )
    publish("kohout-crater", "Kohout et al. 2004, Fig. 13: Crater Lake", rows, out, console, draw, note)
    return rows

"""Figure 13: the Crater Lake terrain, its speed-ups and its picture in relief."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...threaded2d import Delaunay
from . import relief
from .busy import warn_if_busy
from .costs import SHIPPED_NAME, chosen_costs, crater_sites, described
from .paper import CRATER
from .report import Row, publish
from .runs import SpeedupSet, note_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

SPACING = (
    30.0  # metres between grid points, as models of the US Geological Survey have; the data does not say
)
EXAGGERATION = 2.0  # of heights


def crater(
    out: Path, console: Console, *, points: int = 100_001, repeats: int = 3, seed: int = 0,
    costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, Figure 13: Crater Lake, batch and circum-circle as published, and in relief.

    PyVista renders the relief; without it the picture is one from above, and a line says so. The
    triangles are those of the circum-circle method by four threads, which begin with slabs and take sites
    from each other.
    """
    sites = crater_sites(points, seed)
    warn_if_busy(console)
    table = chosen_costs(costs, [("crater", points, 1)])
    given = SpeedupSet("crater", sites[:, :2], table)
    rows: list[Row] = []
    for method, (two, four) in CRATER.items():
        rows.append({"method": method, "paper 2": two, "paper 4": four} | given.row(method, repeats))
    tri = Delaunay(sites[:, :2], method="circumcircle", threads=4, subdivision="x-slabs")

    def draw(axes: Axes) -> None:
        try:
            relief.paint(axes, tri, sites[:, 2], spacing=SPACING, exaggeration=EXAGGERATION)
        except ImportError as error:
            console.print(f"{error}. The picture is one seen from above.", markup=False)
            from_above(axes, tri, sites)
        axes.set_title(
            f"Crater Lake, {len(sites):,} points, heights times {EXAGGERATION:g}; colours: threads"
        )

    note = (
        f"{len(sites):,} points of the terrain. {note_of(table.source, repeats)} "
        f"Costs: {described(table.of('crater', len(sites)))}."
    )
    publish("kohout-crater", "Kohout et al. 2004, Fig. 13: Crater Lake", rows, out, console, draw, note)
    return rows


def from_above(axes: Axes, tri: Delaunay, sites: np.ndarray) -> None:
    """The terrain seen from above, shaded, with the threads' colours: what matplotlib alone can draw."""
    corners = sites[tri.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / [SPACING, SPACING, 1]
    light = normals @ [-0.5, 0.5, 0.7] / np.linalg.norm(normals, axis=1)
    x, y = tri.points.T * SPACING / 1000
    y = y.max() - y
    axes.tripcolor(x, y, tri.triangles, facecolors=light, cmap="gray", rasterized=True)
    axes.tripcolor(
        x, y, tri.triangles, facecolors=tri.thread, cmap="tab10", vmin=0, vmax=9, alpha=0.3, rasterized=True
    )
    axes.set(xlabel="km to the east", ylabel="km to the north", aspect="equal")

"""A triangulation in space on a plotter of PyVista: cut open towards the eye, and tetrahedra shrunk.

The hull alone, which a plotter shows of a grid, says nothing of what is inside.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, cast

import numpy as np

from ._cell_data import varies
from ._optional import optional
from ._paths import check_extension, check_writable, written_aside
from .plot import CUT, View, camera

if TYPE_CHECKING:
    import pyvista

    from ._triangulation import Triangulation

FORMATS = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")
MOST_WITH_EDGES = 20_000  # tetrahedra; more are all edge
MOST_LEVELS = 256  # of integers, each with a colour of its own
MOST_MARKS = 8  # of these beside the colour bar


class SpaceLook(TypedDict, total=False):
    """Keywords of `Triangulation.plot` for space."""

    scalars: str
    source: pyvista.DataSet | None
    longest: float | None
    shrink: float
    cut: bool
    screenshot: str | Path | None
    off_screen: bool | None
    window_size: tuple[int, int] | None


@dataclass(frozen=True)
class Look:
    """What `plot` shows, and where; `Triangulation.plot` says of each what it is."""

    edges: bool | None = None
    colormap: str | None = None
    scalars: str = "depth"
    source: pyvista.DataSet | None = None
    longest: float | None = None
    shrink: float = 0.8
    cut: bool = True
    screenshot: str | Path | None = None
    off_screen: bool | None = None
    window_size: tuple[int, int] | None = None


def plot(tri: Triangulation, look: Look) -> pyvista.Plotter:
    """A plotter with the tetrahedra, as `Triangulation.plot` says."""
    path = None if look.screenshot is None else _check_screenshot(look.screenshot)
    if not 0 < look.shrink <= 1:
        msg = f"shrink must be above 0 and at most 1, where tetrahedra touch, got {look.shrink!r}"
        raise ValueError(msg)
    pv = optional("pyvista", "a plot in space")
    grid = cast("pyvista.UnstructuredGrid", tri.to_pyvista(look.source))
    _check_scalars(grid, look)
    peeled = _peeled(grid, tri.simplices, look.longest)
    shown = _opened(tri.points[tri.simplices[peeled]], peeled) if look.cut else peeled
    off_screen = path is not None or None if look.off_screen is None else look.off_screen
    with quiet(pv) if off_screen else _aloud():
        plotter: pyvista.Plotter = pv.Plotter(off_screen=off_screen, window_size=look.window_size)
        _add(plotter, grid, shown, look)
        if path is not None:
            with written_aside(path) as aside:
                plotter.screenshot(aside)
    return plotter


@contextmanager
def quiet(pv: Any) -> Iterator[None]:  # Any: PyVista is loaded when it is needed
    """Keep VTK from saying on the terminal that there is no screen."""
    if not hasattr(pv, "vtk_verbosity"):
        yield
        return
    with pv.vtk_verbosity("off"):
        yield


@contextmanager
def _aloud() -> Iterator[None]:
    yield


def _check_screenshot(path: str | Path) -> Path:
    path = Path(path)
    check_extension(path, FORMATS, "write a picture to")
    check_writable(path)
    return path


def _check_scalars(grid: pyvista.UnstructuredGrid, look: Look) -> None:
    names = [*grid.cell_data.keys(), *grid.point_data.keys()]
    if look.scalars not in names:
        msg = (
            f"scalars must be data of cells, or of points of the source, got {look.scalars!r}; "
            f"there are {', '.join(names)}"
        )
        if look.scalars == "iteration":
            msg += "; by insertion all iterations are 1"
        raise ValueError(msg)


def _peeled(grid: pyvista.UnstructuredGrid, simplices: np.ndarray, longest: float | None) -> np.ndarray:
    """The tetrahedra without a longer edge, int (k,)."""
    if not len(simplices):
        msg = "there is nothing to plot: no tetrahedra"
        raise ValueError(msg)
    if longest is None:
        return np.arange(len(simplices))
    edges = np.asarray(grid.cell_data["longest_edge"])
    kept = np.flatnonzero(edges <= longest)
    if not len(kept):
        msg = (
            f"longest={longest!r} leaves no tetrahedra: the longest edges are {edges.min():.6g} at least, "
            f"{np.median(edges):.6g} in the median, and {edges.max():.6g} at most"
        )
        raise ValueError(msg)
    return kept


def _opened(corners: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """The rows of tetrahedra (k, 4, 3) that do not lie before the middle, for the eye; all if none do."""
    middles = corners.mean(axis=1)
    centre = (corners.min(axis=(0, 1)) + corners.max(axis=(0, 1))) / 2
    behind = (middles - centre) @ (CUT @ camera(View())) <= 0
    return rows[behind] if behind.any() else rows


def _add(plotter: pyvista.Plotter, grid: pyvista.UnstructuredGrid, shown: np.ndarray, look: Look) -> None:
    """Put the tetrahedra of some rows on a plotter, and the eye before them."""
    of_cells = look.scalars in grid.cell_data.keys()  # noqa: SIM118  # PyVista's data are no dict
    values = np.asarray((grid.cell_data if of_cells else grid.point_data)[look.scalars])
    part = grid.extract_cells(shown)
    drawn = part.shrink(look.shrink) if look.shrink < 1 else part
    style: dict[str, Any] = {"color": "#9ecae1"}
    if varies(values):
        bar: dict[str, Any] = {"title": look.scalars.replace("_", " ") + "\n", "color": "black"}
        bar |= {"vertical": True, "height": 0.5, "position_x": 0.87, "position_y": 0.25}
        style = {
            "scalars": look.scalars,
            "preference": "cell" if of_cells else "point",
            "cmap": look.colormap or "viridis",
            "scalar_bar_args": bar,
        }
        if values.ndim == 1 and values.dtype.kind in "iu" and np.ptp(values) < MOST_LEVELS:
            least, greatest = int(values.min()), int(values.max())
            style |= {"n_colors": greatest - least + 1, "clim": (least - 0.5, greatest + 0.5)}
            marked = range(least, greatest + 1, -(-(greatest - least) // MOST_MARKS))
            style["annotations"] = {k: str(k) for k in marked}
            bar |= {"n_labels": 0, "fmt": "%.0f"}
    edges = len(shown) <= MOST_WITH_EDGES if look.edges is None else look.edges
    plotter.renderer.set_background("white")
    plotter.add_mesh(drawn, show_edges=edges, edge_color="#303030", ambient=0.2, **style)
    _, up, toward = camera(View())
    centre = np.asarray(part.center)
    plotter.camera_position = [tuple(centre + toward * (part.length or 1.0)), tuple(centre), tuple(up)]
    plotter.renderer.reset_camera()
    plotter.camera.Zoom(1.3)  # VTK's own, which has types
    plotter.enable_anti_aliasing("ssaa")

"""A terrain in relief, coloured by the threads that made its triangles; rendered by PyVista, off screen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._optional import optional
from ..._space_plot import quiet
from ...threaded2d.picture import to_pyvista

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..._triangulation import Triangulation

PALER = 0.45  # of a thread's colour, so that shadows are seen on it
FONT = 0.01  # of the width


def render(
    tri: Triangulation, heights: np.ndarray, *, spacing: float, exaggeration: float = 2.0, width: int = 2400
) -> np.ndarray:
    """The picture of a terrain seen from the south and above, uint8 (height, width, 3), its margins cut off.

    Parameters
    ----------
    tri : threaded2d.Delaunay
        Of columns and rows; rows run to the south.
    heights : float (n,)
        In metres.
    spacing : float
        Metres from one column to the next.
    exaggeration : float
        Heights are drawn so many times.
    width : int
        Pixels of what is rendered; the picture has fewer.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """
    pv = optional("pyvista", "a relief")
    mesh = to_pyvista(tri, exaggeration * (heights - heights.min()))
    mesh.points = mesh.points * [spacing, -spacing, 1]
    mesh.cell_data["colour"] = _colours(tri.thread)
    with _off_screen(width, round(0.7 * width)) as plotter:
        plotter.set_background("white")
        # from the north-west and not too high, as on maps; a faint one from the eye keeps shadows readable
        plotter.add_light(pv.Light(position=(-1, 1, 0.8), light_type="scene light", intensity=0.9))
        plotter.add_light(pv.Light(light_type="headlight", intensity=0.3))
        plotter.add_mesh(mesh, scalars="colour", rgb=True, lighting=True, ambient=0.1, specular=0)
        low, high = mesh.bounds[::2], mesh.bounds[1::2]
        km = [(high[k] - low[k]) / 1000 for k in range(2)]
        plotter.show_bounds(
            axes_ranges=[0, km[0], 0, km[1], heights.min(), heights.max()],
            xtitle="km to the east", ytitle="km to the north", ztitle="height in m",
            n_xlabels=3, n_ylabels=3, n_zlabels=2, fmt="%.0f",
            font_size=round(FONT * width), bold=False, location="outer", color="black",
        )  # fmt: skip
        plotter.camera_position = [(0.35, -1.5, 1.3), (0, 0, 0), (0, 0, 1)]
        plotter.reset_camera(bounds=mesh.bounds)
        picture = np.asarray(plotter.screenshot(return_img=True))
    return _trimmed(picture)


def paint(
    axes: Axes, tri: Triangulation, heights: np.ndarray, *, spacing: float, exaggeration: float = 2.0
) -> None:
    """Put the picture of `render` on matplotlib axes, with a legend of the threads below it."""
    patch = optional("matplotlib.patches").Patch
    axes.imshow(render(tri, heights, spacing=spacing, exaggeration=exaggeration), interpolation="antialiased")
    axes.set_axis_off()
    threads = np.unique(tri.thread)
    colours = _colours(threads) / 255
    axes.legend(
        handles=[patch(color=c, label=f"thread {t}") for t, c in zip(threads, colours, strict=True)],
        loc="upper center", bbox_to_anchor=(0.5, 0), ncols=min(4, len(threads)), frameon=False,
    )  # fmt: skip


@contextmanager
def _off_screen(width: int, height: int) -> Iterator[Any]:  # PyVista's types are wrong where it decorates
    """A plotter without a window, about whose lack VTK does not complain."""
    pv = optional("pyvista")
    with quiet(pv):
        plotter = pv.Plotter(off_screen=True, window_size=(width, height), lighting="none")
        try:
            yield plotter
        finally:
            plotter.close()


def _colours(thread: np.ndarray) -> np.ndarray:
    """Of each thread a colour that is paler than matplotlib's, uint8 (n, 3)."""
    full = optional("matplotlib").colormaps["tab10"](np.asarray(thread) % 10)[:, :3]
    return np.asarray(np.round(255 * (1 - PALER * (1 - full))), np.uint8)


def _trimmed(picture: np.ndarray) -> np.ndarray:
    """Without the white margins, but for some pixels."""
    drawn = np.any(picture < 255, axis=2)
    rows, columns = (np.flatnonzero(np.any(drawn, axis=1 - k)) for k in range(2))
    if not len(rows):
        return picture
    margin = 10
    return picture[
        max(0, rows[0] - margin) : rows[-1] + margin + 1,
        max(0, columns[0] - margin) : columns[-1] + margin + 1,
    ]

"""Pictures of triangulations in files: rendered by PyVista, painted by matplotlib where that cannot be.

Vector formats are painted: what OpenGL renders are pixels.
"""

from __future__ import annotations

import importlib.util
import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ._cell_data import varies
from ._display import renders
from ._optional import optional
from ._output import new_figure, save_figure
from ._paths import written_aside
from ._scene import Choice, Scene, color_range, explained, eye, is_wide, title_of
from ._space_plot import quiet
from .plot import View, check_picture_path, draw

if TYPE_CHECKING:
    import pyvista

    from ._cell_data import Simplices
    from ._mesh import Tetrahedra

VECTORS = (".pdf", ".svg")
WIDTH, HEIGHT = 1400, 1200  # pixels of a panel
BAR = 0.16  # the share of a panel's width that the colour bar takes
HEAD, FOOT = 0.08, 0.06  # of its height: the title, and the line that says what the colours are
HEADLINE = 80  # pixels above the panels
HALF_ANGLE = np.radians(12.0)  # of the view: somewhat longer than a normal lens
EDGES = 0.6  # how dark edges are at most; less where there are many
MOST_EDGES = 40_000  # faces; more are all edge, and their light and shade says enough
INK = "#202020"
EVERYTHING = Choice()


@dataclass(frozen=True)
class Panel:
    """What one part of a picture shows.

    Attributes
    ----------
    choice : Choice
        What is shown.
    title : str
        A line above it; by default the numbers of sites and simplices.
    note : str
        A line below; by default what the colours are.
    """

    choice: Choice = EVERYTHING
    title: str = ""
    note: str = ""


def draw_picture(
    tri: Tetrahedra | Simplices, path: str | Path, panels: Sequence[Panel] = (Panel(),), headline: str = ""
) -> None:
    """Write a picture of a triangulation, one panel beside the other.

    Where OpenGL or PyVista is missing, the picture is painted by matplotlib, and the logger `dt3d` says so.

    Parameters
    ----------
    tri : Delaunay, Subset or Mesh
        What is shown.
    path : str or Path
        .png or .jpg, which are rendered; .pdf or .svg, which are painted: for up to some thousand tetrahedra.
    panels : sequence of Panel
        What is shown in each.
    headline : str
        A line above all panels.

    Raises
    ------
    ValueError
        For another extension, and as `Scene.chosen` says.
    OSError
        If the file cannot be written.
    ImportError
        If matplotlib is missing, too.
    """
    path = check_picture_path(path)
    scene = Scene(tri)
    chosen = [replace(panel, choice=scene.chosen(panel.choice)) for panel in panels]
    vector = path.suffix.lower() in VECTORS
    why = None if vector else _missing()
    if vector or why:
        if why:
            logging.getLogger("dt3d").warning("%s, so the picture is painted by matplotlib", why)
        _paint(scene, tri, path, chosen)
        return
    pv = optional("pyvista", "a picture")
    with quiet(pv):
        plotter = _plotter(pv, len(chosen), headline)
        for column, panel in enumerate(chosen):
            plotter.subplot(1 if headline else 0, column)
            render(plotter, scene, panel)
        with written_aside(path) as aside:
            plotter.screenshot(aside)
        plotter.close()


def _plotter(
    pv: Any,  # PyVista is loaded when it is needed
    columns: int,
    headline: str,
) -> pyvista.Plotter:
    """A plotter with a part for each panel, and above them the headline."""
    if not headline:
        size = (WIDTH * columns, HEIGHT)
        return cast(
            "pyvista.Plotter", pv.Plotter(off_screen=True, shape=(1, columns), window_size=size, border=False)
        )
    plotter: pyvista.Plotter = pv.Plotter(
        off_screen=True,
        shape=(2, columns),
        row_weights=[HEADLINE, HEIGHT],
        groups=[(0, np.s_[:])],
        window_size=(WIDTH * columns, HEIGHT + HEADLINE),
        border=False,
    )
    plotter.subplot(0, 0)
    whiten(plotter)
    _write(plotter, headline, (0.03 / columns, 0.1), 30)
    return plotter


def render(plotter: pyvista.Plotter, scene: Scene, panel: Panel) -> None:
    """Put what a panel shows on the plotter's active part."""
    choice = panel.choice
    scalars = cast(str, choice.scalars)
    mesh = surface(scene, choice)
    look = coloured(scalars, scene.values(scalars), of_points=scalars in scene.point_data)
    whiten(plotter)
    lay(plotter, mesh, look, edges=mesh.n_cells <= MOST_EDGES, width=2.0)  # smoothing makes it 1
    if "scalars" in look:
        add_bar(plotter, scalars, look, 34)
        _write(plotter, panel.note or explained(scalars), (0.03, 0.2 * FOOT), 20)
    kind = "triangles" if scene.plane else "tetrahedra"
    sites = len(np.unique(scene.simplices))
    title = panel.title or f"{sites:,} sites, {len(scene.simplices):,} {kind}" + left_out(choice)
    _write(plotter, title, (0.03, 1 - 0.75 * HEAD), 26)
    look_at(plotter, mesh, choice)
    plotter.enable_anti_aliasing("ssaa")
    if not scene.plane:
        # shade where little light gets in: depth is seen without edges, too
        cast(Any, plotter).enable_ssao(radius=mesh.length / 25, bias=mesh.length / 800, kernel_size=16)


def whiten(plotter: pyvista.Plotter) -> None:
    """A white ground for the plotter's active part."""
    cast(Any, plotter).set_background("white", all_renderers=False)  # decorated, a function to mypy


def lay(
    plotter: pyvista.Plotter, mesh: pyvista.PolyData, look: dict[str, Any], *, edges: bool, width: float = 1.0
) -> None:
    """Put faces on a plotter, in place of those that were there; edges in a width of pixels."""
    plotter.add_mesh(
        mesh,
        name="simplices",
        show_edges=edges,
        edge_color=INK,
        edge_opacity=min(EDGES, 70 / np.sqrt(mesh.n_cells + 1)),
        line_width=width,
        ambient=0.45,
        diffuse=0.7,
        show_scalar_bar=False,
        reset_camera=False,
        render=False,
        **look,
    )


def add_bar(plotter: pyvista.Plotter, name: str, look: dict[str, Any], size: int) -> None:
    """What the colours of some data mean, in letters of a size in pixels."""
    bar = cast(Any, plotter).add_scalar_bar(  # decorated, a function to mypy
        title=f"{title_of(name)}\n",
        mapper=plotter.mapper,
        vertical=True,
        width=0.05,
        height=0.55,
        position_x=1 - 0.85 * BAR,
        position_y=0.2,
        color=INK,
        title_font_size=size,
        label_font_size=size - 3,
        n_labels=0 if "annotations" in look else 5,
        fmt="%.3g",
        render=False,
    )
    bar.SetUnconstrainedFontSize(True)


def surface(scene: Scene, choice: Choice) -> pyvista.PolyData:
    """The faces that a choice shows, of their own points, with the data of all cells and points."""
    pv = optional("pyvista", "a picture")
    faces, owners = scene.faces(scene.shown(choice))
    used, numbers = np.unique(faces, return_inverse=True)
    mesh: pyvista.PolyData = pv.PolyData.from_regular_faces(scene.points[used], numbers.reshape(-1, 3))
    for name, values in scene.data.items():
        mesh.cell_data[name] = values[owners]
    for name, values in scene.point_data.items():
        mesh.point_data[name] = values[used]
    return mesh


def coloured(name: str, values: np.ndarray, *, of_points: bool = False) -> dict[str, Any]:
    """Keywords of PyVista's `add_mesh` that colour by some data; one colour where they do not vary."""
    if not varies(values):
        return {"color": "#9ecae1"}
    low, high = color_range(values)
    look: dict[str, Any] = {"scalars": name, "cmap": "viridis", "clim": (low, high)}
    look["preference"] = "point" if of_points else "cell"
    if is_wide(values):
        look["log_scale"] = True
    elif values.dtype.kind in "iu" and high - low < 256:
        count = int(high - low) + 1
        marked = range(int(low), int(high) + 1, -(-count // 8))
        look |= {"n_colors": count, "clim": (low - 0.5, high + 0.5)}
        look["annotations"] = {float(k): str(k) for k in marked}
    return look


def left_out(choice: Choice) -> str:
    """What a choice leaves out, as the end of a sentence."""
    words = ", cut open" if choice.cut else ""
    if choice.longest is not None and np.isfinite(choice.longest):
        words += f", edges up to {choice.longest:.3g}"
    return words + (f", up to iteration {choice.upto}" if choice.upto is not None else "")


def look_at(
    plotter: pyvista.Plotter, mesh: pyvista.PolyData, choice: Choice, head: float = HEAD, foot: float = FOOT
) -> None:
    """Put the eye where the mesh just fits beside the colour bar, and between lines above and below.

    Parameters
    ----------
    plotter, mesh, choice
        Where it is shown, what, and from where.
    head, foot : float
        What the lines take, as shares of the height.
    """
    width, height = plotter.renderer.GetSize()
    rows = eye(choice)
    seen = np.asarray(mesh.points, np.float64) @ rows.T  # right, up, towards the eye
    tall, wide = np.tan(HALF_ANGLE), np.tan(HALF_ANGLE) * width / height
    fill = np.array([wide * (0.97 - BAR), tall * (1 - head - foot)])
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    for _ in range(5):  # nearer points are larger, so the middle of the picture is not that of the mesh
        offset = seen - middle
        distance = (np.abs(offset[:, :2]) / fill + offset[:, 2:]).max()
        flat = offset[:, :2] / (distance - offset[:, 2:])
        middle[:2] += distance * (flat.min(axis=0) + flat.max(axis=0)) / 2
    focus = middle @ rows
    camera = plotter.camera
    plotter.camera_position = [
        tuple(focus + rows[2] * max(distance, 1e-300)),
        tuple(focus),
        tuple(rows[1]),
    ]
    camera.SetViewAngle(2 * np.degrees(HALF_ANGLE))
    camera.SetWindowCenter(BAR - 0.03, head - foot)
    plotter.renderer.ResetCameraClippingRange()


def _write(plotter: pyvista.Plotter, text: str, place: tuple[float, float], size: int) -> None:
    cast(Any, plotter).add_text(text, position=place, viewport=True, font_size=size, color=INK)


def _missing() -> str | None:
    """Why nothing can be rendered; None if it can."""
    if importlib.util.find_spec("pyvista") is None:
        return "PyVista is not installed"
    return None if renders() else "VTK cannot render here (there is no OpenGL library)"


def _paint(scene: Scene, tri: Tetrahedra | Simplices, path: Path, panels: Sequence[Panel]) -> None:
    """The same by matplotlib, coloured by iteration or depth."""
    if scene.plane:
        _paint_plane(scene, path)
        return
    views = []
    for panel in panels:
        choice = panel.choice
        assert choice.azimuth is not None
        assert choice.elevation is not None
        longest = choice.longest if choice.longest is not None and np.isfinite(choice.longest) else None
        views.append(
            View(
                panel.title,
                shrink=0.85,
                cut=bool(choice.cut),
                longest=longest,
                upto=choice.upto,
                azimuth=choice.azimuth,
                elevation=choice.elevation,
            )
        )
    draw(cast("Tetrahedra", tri), path, views)


def _paint_plane(scene: Scene, path: Path) -> None:
    """Triangles, coloured by depth."""
    figure = new_figure(6, 6)
    ax = figure.add_subplot()
    patches = optional("matplotlib.collections").PolyCollection(
        scene.points[scene.simplices][:, :, :2], array=scene.data["depth"], edgecolors="white", linewidths=0.2
    )
    ax.add_collection(patches)
    ax.autoscale_view()
    ax.set_aspect("equal")
    figure.colorbar(patches, label="depth")
    save_figure(figure, path, dpi=200)

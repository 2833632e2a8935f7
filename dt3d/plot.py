"""Pictures of the tetrahedra, coloured by the iteration that found them; by depth where all are of one.

They are painted back to front on a matplotlib figure, so they need neither a screen nor an OpenGL library.
A theorem makes this possible: seen from any point, the tetrahedra of a Delaunay triangulation can be ordered
so that none hides one that is painted after it, namely by falling power of the eye with respect to their
circumspheres (H. Edelsbrunner, An acyclicity theorem for cell complexes in d dimension, Combinatorica 10,
1990).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from ._cell_data import neighbors_of
from ._optional import optional
from ._output import save_figure as save_figure
from ._paths import check_extension, check_writable
from ._topology import OUTWARD

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ._mesh import Tetrahedra

FORMATS = (".png", ".pdf", ".svg", ".jpg")

# a tetrahedron is cut away if its middle lies on this side of a plane, to the right, up and towards the eye
CUT = np.array([0.5, 0.15, 0.85])
EYE = 4.0  # distance of the eye from the centre, in radii of the set


@dataclass(frozen=True)
class View:
    """What one panel of a picture shows.

    Attributes
    ----------
    title : str
        A line above the panel.
    shrink : float
        Size of each tetrahedron about its own centre; below 1 gaps open and let one see inside.
    cut : bool
        Leave out what lies before a plane through the middle, slightly turned to the eye.
    longest : float, optional
        Leave out tetrahedra with an edge longer than this; what stays of a molecule is its body.
    upto : int, optional
        Show only what was found up to this iteration.
    azimuth, elevation : float
        Where the eye is, in degrees about the z axis and above the xy plane.
    """

    title: str = ""
    shrink: float = 0.8
    cut: bool = True
    longest: float | None = None
    upto: int | None = None
    azimuth: float = 35.0
    elevation: float = 22.0


def draw(
    tri: Tetrahedra,
    path: str | Path,
    views: View | Sequence[View] = View(),
    *,
    width: int = 1400,
    height: int = 1200,
) -> None:
    """Write a picture of a triangulation, one panel per view, side by side.

    Parameters
    ----------
    tri : Delaunay
        Anything with ``points``, ``simplices`` and ``iteration``.
    path : str or Path
        .png, .pdf, .svg or .jpg; vector formats suit up to some thousand tetrahedra.
    views : View or sequence of View
        A panel for each.
    width, height : int
        Pixels of one panel.

    Raises
    ------
    ValueError
        For another extension.
    OSError
        If the file cannot be written; an older one is then as it was.
    ImportError
        If matplotlib is not installed.
    """
    path = check_picture_path(path)
    mpl = _import_matplotlib()
    views = [views] if isinstance(views, View) else list(views)
    levels = _levels(tri)

    # a strip on the right holds the colour bar
    bar, dpi, size = 0.11 * width, 100, height / 65
    whole = width * len(views) + bar
    figure = mpl.figure.Figure(figsize=(whole / dpi, height / dpi), dpi=dpi, facecolor="white")
    for k, view in enumerate(views):
        ax = figure.add_axes(((k + 0.02) * width / whole, 0.02, 0.96 * width / whole, 0.92))
        paint(tri, ax, view, title_size=size)
    if levels.count > 1:
        axes = figure.add_axes(((whole - bar) / whole, 0.25, 0.25 * bar / whole, 0.5))
        _add_scale(mpl, figure, axes, levels, size)
    save_figure(figure, path)


def _add_scale(mpl: ModuleType, figure: Figure, axes: Axes, levels: _Levels, size: float) -> None:
    """The colour bar of the iterations, or depths."""
    colors = mpl.colors.ListedColormap(_palette(mpl, levels))
    first, end = levels.first, levels.first + levels.count
    norm = mpl.colors.BoundaryNorm(np.arange(first - 0.5, end), levels.count)
    ticks = range(first, end, -(-levels.count // 12))
    scale = figure.colorbar(mpl.cm.ScalarMappable(norm, colors), cax=axes, ticks=ticks)
    scale.set_label(levels.name, size=size, labelpad=size)
    scale.ax.tick_params(labelsize=size, length=0)
    scale.outline.set_visible(False)


def paint(tri: Tetrahedra, ax: Axes, view: View = View(), *, title_size: float = 12) -> None:
    """Paint a triangulation on matplotlib axes, which it clears of ticks and frame.

    Parameters
    ----------
    tri : Delaunay
        Anything with ``points``, ``simplices`` and ``iteration``.
    ax : matplotlib.axes.Axes
        Where it is painted.
    view : View
        What is shown, and from where.
    title_size : float
        In points.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    mpl = _import_matplotlib()
    axes = camera(view)

    # the unit ball about the used points; several pictures of one set agree in scale
    used = tri.points[np.unique(tri.simplices)]
    centre = (used.min(axis=0) + used.max(axis=0)) / 2
    radius = np.linalg.norm(used - centre, axis=1).max()
    corners = (((tri.points - centre) / radius) @ axes.T)[tri.simplices]

    shown = _shown(corners * radius, tri.iteration, view)
    levels = _levels(tri)
    corners, level = corners[shown], levels.values[shown] - levels.first
    order = _back_to_front(corners)
    corners, level = corners[order], level[order]
    middle = corners.mean(axis=1, keepdims=True)
    corners = middle + view.shrink * (corners - middle)

    # faces turned to the eye, which is at (0, 0, EYE): x to the right, y up, z to the eye
    faces = corners[:, OUTWARD]
    normal = np.cross(faces[:, :, 1] - faces[:, :, 0], faces[:, :, 2] - faces[:, :, 0])
    normal /= np.linalg.norm(normal, axis=2, keepdims=True) + np.finfo(float).tiny
    visible = np.einsum("mfk,mfk->mf", normal, [0.0, 0.0, EYE] - faces[:, :, 0]) > 0
    faces, normal = faces[visible], normal[visible]
    flat = faces[:, :, :2] * (EYE / (EYE - faces[:, :, 2:]))

    color = _palette(mpl, levels)[np.repeat(level, visible.sum(axis=1))]
    color = _light(color, normal, faces[:, :, 2].mean(axis=1))
    # thin dark outlines, thinner the more there are; they also close the seams between faces
    thickness = np.clip(30 / np.sqrt(len(flat) + 1), 0.05, 0.5)
    ax.add_collection(
        mpl.collections.PolyCollection(flat, facecolors=color, edgecolors=0.6 * color, linewidths=thickness)
    )
    # room for all the sites, so that pictures of a growing set stay in place
    sites = ((used - centre) / radius) @ axes.T
    sites = sites[:, :2] * (EYE / (EYE - sites[:, 2:]))
    (left, low), (right, high) = sites.min(axis=0), sites.max(axis=0)
    ax.set(xlim=(left, right), ylim=(low, high), aspect="equal")
    ax.margins(0.02)
    ax.axis("off")
    ax.set_title(view.title, size=title_size)


def check_picture_path(path: str | Path) -> Path:
    """The path, if a picture can be written there; a ValueError or OSError if not."""
    path = Path(path)
    check_extension(path, FORMATS, "draw")
    check_writable(path)
    return path


@dataclass(frozen=True)
class _Levels:
    """The integers that colours show: their name, that of each tetrahedron, the least, how many there are."""

    name: str
    values: np.ndarray
    first: int
    count: int


def _levels(tri: Tetrahedra) -> _Levels:
    """The iterations of tetrahedra; their depths where all were found by the first, as by insertion."""
    from .geometry.depths import depths

    iteration = np.asarray(tri.iteration)
    last = int(np.max(iteration, initial=1))
    if last > 1:
        return _Levels("found in iteration", iteration, 1, last)
    neighbors = getattr(tri, "neighbors", None)
    depth = depths(neighbors_of(np.asarray(tri.simplices)) if neighbors is None else np.asarray(neighbors))
    depth = np.maximum(depth, 0)  # of damaged meshes
    return _Levels("depth: facets to the hull", depth, 0, int(np.max(depth, initial=0)) + 1)


def _palette(mpl: ModuleType, levels: _Levels) -> np.ndarray:
    """A colour for every level: float64 (count, 3); where there is one only, a light one."""
    if levels.count == 1:
        return np.array([mpl.colors.to_rgb("#9ecae1")])
    # iterations from blue through pale yellow to red: told apart by colour-blind eyes, and under light and
    # shade; depths as in what PyVista renders
    colors = mpl.colormaps["RdYlBu_r" if levels.first else "viridis"]
    return np.asarray(colors(np.linspace(0.0, 1.0, levels.count)))[:, :3]


def camera(view: View) -> np.ndarray:
    """The directions of a view, float64 (3, 3): rows to the right, up, and towards the eye."""
    a, e = np.radians([view.azimuth, view.elevation])
    toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.stack([right, np.cross(toward, right), toward])


def _shown(corners: np.ndarray, iteration: np.ndarray, view: View) -> np.ndarray:
    shown = np.ones(len(corners), bool)
    if view.upto is not None:
        shown &= iteration <= view.upto
    if view.longest is not None:
        edges = corners[:, [0, 0, 0, 1, 1, 2]] - corners[:, [1, 2, 3, 2, 3, 3]]
        shown &= np.linalg.norm(edges, axis=2).max(axis=1) <= view.longest
    if view.cut:
        shown &= corners.mean(axis=1) @ CUT < 0
    return shown


def _back_to_front(corners: np.ndarray) -> np.ndarray:
    """The painter's order: by falling power of the eye with respect to the circumspheres."""
    origin = corners[:, 0] - [0.0, 0.0, EYE]
    edges = corners[:, 1:] - corners[:, :1]
    squared = np.einsum("mik,mik->mi", edges, edges)
    # 2 edges . (circumcentre - a) = squared, by Cramer's rule; det is positive, if tiny for a sliver
    u, v, w = edges.swapaxes(0, 1)
    numerator = (
        squared[:, :1] * np.cross(v, w) + squared[:, 1:2] * np.cross(w, u) + squared[:, 2:] * np.cross(u, v)
    )
    det = np.einsum("mk,mk->m", np.cross(u, v), w)
    with np.errstate(divide="ignore", invalid="ignore"):
        # |eye - circumcentre|^2 - r^2, with the eye as origin and r^2 = |circumcentre - a|^2
        power = np.einsum("mk,mk->m", origin, origin + numerator / det[:, None])
    # cospherical neighbours tie (the cells of a grid, split); among them the farther centre goes first
    distance = np.linalg.norm(corners.mean(axis=1) - [0.0, 0.0, EYE], axis=1)
    return np.lexsort([-distance, -np.round(np.nan_to_num(power, nan=0.0), 9)])


def _light(color: np.ndarray, normal: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Faces brighten towards a lamp at the upper left, and fade into the background with distance."""
    lamp = np.array([-0.35, 0.55, 0.75])
    lit = color * (0.55 + 0.5 * np.clip(normal @ (lamp / np.linalg.norm(lamp)), 0.0, 1.0))[:, None]
    haze = 0.18 * np.clip(1.0 - depth, 0.0, 2.0)[:, None] / 2.0
    return np.asarray(np.clip(lit * (1.0 - haze) + haze, 0.0, 1.0))


def _import_matplotlib() -> ModuleType:
    for module in ("cm", "collections", "figure"):
        optional(f"matplotlib.{module}", "a picture")
    matplotlib: ModuleType = optional("matplotlib", "a picture")
    return matplotlib

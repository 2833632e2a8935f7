"""What notebooks show of a triangulation: a table, and a small drawing where there are few simplices.

The drawing is SVG, written here: no window, no OpenGL, no library, nothing to compile, and done in 0.1 s.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from ._topology import OUTSIDE, OUTWARD
from .plot import CUT, View, camera

if TYPE_CHECKING:
    from ._triangulation import Triangulation

MOST_SIMPLICES = 50_000  # with a drawing; it takes time in proportion
MOST_FACES = 2500  # some 150 kB
WIDTH = 260  # pixels, and the most of the height
# viridis, from the dark end
COLORS = ("#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#a0da39", "#fde725")


def to_html(tri: Triangulation) -> str:
    """A table of what it is, with a drawing of some thousand triangles beside it: HTML."""
    rows = "".join(
        f'<tr><th style="text-align:left">{name}</th><td style="text-align:right">{value}</td></tr>'
        for name, value in _rows(tri)
    )
    drawing = _drawing(tri)
    return (
        '<div style="display:flex;gap:2em;align-items:center">'
        f"<table><caption>{_name(tri)}</caption>{rows}</table>{drawing}</div>"
    )


def _name(tri: Triangulation) -> str:
    return f"dt3d.{type(tri).__name__} in {'the plane' if tri.ndim == 2 else 'space'}"


def _rows(tri: Triangulation) -> Iterator[tuple[str, str]]:
    yield "sites", f"{len(tri.points):,}"
    yield "triangles" if tri.ndim == 2 else "tetrahedra", f"{len(tri.simplices):,}"
    stats = getattr(tri, "stats", None)
    border = np.count_nonzero(tri.neighbors == OUTSIDE)
    yield (
        ("edges" if tri.ndim == 2 else "facets") + (" of the hull" if stats else " of the border"),
        f"{border:,}",
    )
    if len(tri.duplicates):
        yield "duplicates", f"{len(tri.duplicates):,}"
    if stats is not None:
        extrapolated = hasattr(stats, "face_expansions")
        yield "method", "extrapolation" if extrapolated else "insertion"
        if not extrapolated:
            yield "threads", f"{stats.threads:,}"
        yield "seconds", f"{stats.seconds.get('total', 0.0):.3g}"


def _drawing(tri: Triangulation) -> str:
    """SVG of the triangles, or of the tetrahedra, cut open; "" where there are none or many."""
    from .geometry.depths import depths

    if not 0 < len(tri.simplices) <= MOST_SIMPLICES:
        return ""
    if tri.ndim == 2:
        if len(tri.simplices) > MOST_FACES:
            return ""
        scaled = tri.points / (np.abs(tri.points).max() or 1.0)
        return _svg(scaled[tri.simplices], depths(tri.neighbors), np.ones(len(tri.simplices)))
    # to the right, up, towards the eye; scaled first, since coordinates may be as great as float64 has them
    scaled = tri.points / (np.abs(tri.points).max() or 1.0)
    corners = scaled[tri.simplices] @ camera(View()).T
    along = corners.mean(axis=1) @ CUT
    shown = along <= (along.min() + along.max()) / 2
    rows = np.flatnonzero(shown)
    beside = tri.neighbors[rows]
    row, k = np.nonzero((beside == OUTSIDE) | ~shown[beside])
    owners = rows[row]
    faces = corners[owners[:, None], OUTWARD[k]]
    size = np.ptp(faces, axis=(0, 1)).max()
    if not size > 0:
        return ""
    faces = (faces - faces.mean(axis=(0, 1))) / size
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + np.finfo(float).tiny
    seen = np.flatnonzero(normals[:, 2] > 0)
    if len(seen) > MOST_FACES:
        return ""
    order = seen[np.argsort(faces[seen, :, 2].mean(axis=1), kind="stable")]
    light = 0.55 + 0.45 * np.clip(normals[order] @ np.array([-0.35, 0.55, 0.75]), 0.0, 1.0)
    return _svg(faces[order, :, :2], depths(tri.neighbors)[owners[order]], light)


def _svg(corners: np.ndarray, depth: np.ndarray, light: np.ndarray) -> str:
    """Triangles (f, 3, 2), painted in this order, coloured by depth (f,) under light (f,)."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    size = (high - low).max()
    if not 0 < size < np.inf:
        return ""
    places = (corners - low) * [1.0, -1.0] * ((WIDTH - 4) / size)
    places -= places.min(axis=(0, 1)) - 2
    height = int(np.ceil(places[:, :, 1].max() + 2))
    width = int(np.ceil(places[:, :, 0].max() + 2))
    anchors = np.array([[int(c[i : i + 2], 16) for i in (1, 3, 5)] for c in COLORS], float)
    at = depth / max(1, depth.max()) * (len(anchors) - 1)
    channels = [np.interp(at, np.arange(len(anchors)), channel) * light for channel in anchors.T]
    colors = np.clip(np.stack(channels, axis=1), 0, 255).astype(int)
    return (
        f'<svg width="{width}" height="{height}" style="background:white" stroke="#202020" '
        f'stroke-width="0.3" stroke-linejoin="round">{"".join(_polygons(places, colors))}</svg>'
    )


def _polygons(places: np.ndarray, colors: np.ndarray) -> Iterable[str]:
    for triangle, (red, green, blue) in zip(places.tolist(), colors.tolist(), strict=True):
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in triangle)
        yield f'<path d="M{points}z" fill="#{red:02x}{green:02x}{blue:02x}"/>'

"""A triangulation as one page for browsers: the mesh, and a small program that draws it by WebGL 2.

PyVista's own `export_html` makes pages, too: they carry a scene that can be turned, 2 MB of VTK's code, and
no controls, since sliders call Python. A page with the mesh itself can cut and peel it anywhere: it needs no
Python, no server and no network, which its security policy forbids. Colours are bytes and the arrays packed,
so 150,000 tetrahedra are 5 MB.

``#cut=0.3&scalar=volume&longest=6&upto=2&azimuth=80&elevation=20&edges=0`` behind the address sets the
controls.
"""

from __future__ import annotations

import base64
import gzip
import html
import json
from importlib.resources import files
from pathlib import Path
from typing import Any, cast

import numpy as np

from ._cell_data import varies
from ._paths import check_extension, check_writable, written_aside
from ._scene import Choice, Scene, color_range, explained, is_wide, title_of
from .plot import CUT

EXTENSIONS = (".html", ".htm")
MOST_CELLS = 1_000_000  # of a page, which browsers then still draw as sliders move; 40 MB
LABELS = 6  # beside the colours
ALL = 2.0  # as a share of the longest edge: nothing is longer


def check_page_path(path: str | Path) -> Path:
    """The path, if a page can be written there; a ValueError or OSError if not."""
    path = Path(path)
    check_extension(path, EXTENSIONS, "write a page to")
    check_writable(path)
    return path


def write_page(scene: Scene, choice: Choice, path: str | Path, title: str = "dt3d") -> list[str]:
    """Write a page.

    Parameters
    ----------
    scene : Scene
        What is shown. Of more than a million simplices those around the middle are.
    choice : Choice
        What of it at first, as `Scene.chosen` returns it.
    path : str or Path
        .html or .htm
    title : str
        A headline.

    Returns
    -------
    list of str
        Lines that say what was written, and what was left out.

    Raises
    ------
    ValueError
        For another extension.
    OSError
        If it cannot be written.
    """
    path = check_page_path(path)
    rows = _rows(scene)
    left = ""
    if len(rows) < len(scene.simplices):
        kind = "triangles" if scene.plane else "tetrahedra"
        left = f"the page has {len(rows):,} of {len(scene.simplices):,} {kind}: those around the middle"
    arrays = _arrays(scene, rows)
    about = _about(scene, choice, len(rows), left)
    about["arrays"], packed = _packed(arrays)
    text = (files(__package__) / "_page.html").read_text(encoding="utf-8")
    parts = {
        "@title@": html.escape(title),
        "@about@": json.dumps(about).replace("<", "\\u003c"),
        "@packed@": base64.b64encode(packed).decode("ascii"),
    }
    for name, value in parts.items():
        text = text.replace(name, value)
    with written_aside(path) as aside:
        aside.write_text(text, encoding="utf-8")
    return [
        *([left] if left else []),
        f"wrote {path} ({len(text) / 1e6:.1f} MB, for any browser, without a network)",
    ]


def _rows(scene: Scene) -> np.ndarray:
    """The simplices that a page has, int (k,): all of them, or those in a box about the middle."""
    m = len(scene.simplices)
    if m <= MOST_CELLS:
        return np.arange(m)
    low, high = scene.middles.min(axis=0), scene.middles.max(axis=0)
    half = np.where(high > low, (high - low) / 2, 1.0)
    off = (np.abs(scene.middles - (low + high) / 2) / half).max(axis=1)
    return np.sort(np.argpartition(off, MOST_CELLS)[:MOST_CELLS])


def _arrays(scene: Scene, rows: np.ndarray) -> dict[str, np.ndarray]:
    """What the page's program reads, by name."""
    used, simplices = np.unique(scene.simplices[rows], return_inverse=True)
    number = np.full(len(scene.simplices) + 1, -1, np.int32)  # the last one for those outside
    number[rows] = np.arange(len(rows), dtype=np.int32)
    edges = scene.data["longest_edge"]
    arrays = {
        "points": scene.points[used].astype(np.float32).ravel(),
        "simplices": simplices.astype(np.int32).ravel(),
        "neighbors": number[scene.neighbors[rows]].ravel(),
        "longest": (edges[rows] / edges.max()).astype(np.float32),
    }
    if scene.last > 1:
        arrays["iteration"] = np.minimum(scene.data["iteration"][rows], 2**16 - 1).astype(np.uint16)
    for name, values in scene.data.items():
        arrays[f"of {name}"] = _levels(values)[rows]
    for name, values in scene.point_data.items():
        arrays[f"at {name}"] = _levels(values)[used]
    return arrays


def _levels(values: np.ndarray) -> np.ndarray:
    """Places among the colours, uint8 (m,)."""
    low, high = color_range(values)
    if not high > low:
        return np.full(len(values), 128, np.uint8)
    within = np.clip(np.nan_to_num(values, nan=high), low, high)
    if is_wide(values):
        within, low, high = np.log(within), np.log(low), np.log(high)
    levels: np.ndarray = np.round(255 * ((within - low) / (high - low))).astype(np.uint8)
    return levels


def _labels(values: np.ndarray) -> list[str]:
    """Beside the colours, from above; none where there is one colour."""
    low, high = color_range(values)
    if not varies(values) or not high > low:
        return []
    if values.dtype.kind in "iu":
        count = min(int(high - low) + 1, LABELS)
        return [f"{round(x)}" for x in np.linspace(high, low, count)]
    marks = np.geomspace(high, low, LABELS) if is_wide(values) else np.linspace(high, low, LABELS)
    return [f"{x:.3g}" for x in marks]


def _about(scene: Scene, choice: Choice, count: int, left: str) -> dict[str, Any]:
    """What the page's program is told."""
    edges = scene.data["longest_edge"]
    longest = float(edges.max())
    shares = edges[edges > 0] / longest
    peeled = choice.longest is not None and choice.longest < longest
    return {
        "simplices": count,
        "corners": scene.simplices.shape[1],
        "kind": "triangles" if scene.plane else "tetrahedra",
        "left": left,
        "longest": longest,
        "lowest": min(float(np.quantile(shares, 0.02)), 0.999) if len(shares) else 0.5,
        "last": scene.last,
        "cut": (CUT / np.linalg.norm(CUT)).tolist(),
        "colors": base64.b64encode(_colors()).decode("ascii"),
        "scalars": {
            name: {"title": title_of(name), "meaning": explained(name), "labels": _labels(values)}
            for name, values in {**scene.data, **scene.point_data}.items()
            if varies(values) or name == choice.scalars
        },
        "first": {
            "scalar": choice.scalars,
            "cut": choice.cut,
            "longest": cast(float, choice.longest) / longest if peeled else ALL,
            "upto": scene.last if choice.upto is None else min(choice.upto, scene.last),
            "edges": True,
            "azimuth": choice.azimuth,
            "elevation": choice.elevation,
        },
    }


def _packed(arrays: dict[str, np.ndarray]) -> tuple[list[dict[str, Any]], bytes]:
    """Where each array is in the bytes that a browser unpacks, and these, packed."""
    places, parts, offset = [], [], 0
    for name, values in sorted(arrays.items(), key=lambda item: -item[1].itemsize):  # so all are aligned
        kind = values.dtype.kind + str(values.dtype.itemsize)
        places.append({"name": name, "type": kind, "offset": offset, "length": values.size})
        part = values.astype(values.dtype.newbyteorder("<")).tobytes()
        parts.append(part)
        offset += len(part)
    return places, gzip.compress(b"".join(parts), compresslevel=6, mtime=0)


def _colors() -> bytes:
    """256 colours, as PyVista's pictures have them: red, green and blue of each."""
    anchors = np.array([int(VIRIDIS[k : k + 6], 16) for k in range(0, len(VIRIDIS), 6)])
    red_green_blue = np.stack([anchors >> 16, anchors >> 8 & 255, anchors & 255])
    at = np.linspace(0, len(anchors) - 1, 256)
    table = np.stack([np.interp(at, np.arange(len(anchors)), channel) for channel in red_green_blue], axis=1)
    return bytes(np.round(table).astype(np.uint8).ravel())


# viridis at 17 places, so that a page needs no matplotlib
VIRIDIS = (
    "44015448186a472d7b4240863b528b33638d2c728e26828e21918c1fa08828ae803fbc735ec96284d44baddc30d8e219fde725"
)

"""A tile of a laser scan, in map coordinates: what SciPy loses there, and the surface of all points.

Eastings and northings have six or seven digits before the point and centimetres behind it. Qhull lifts sites
to x^2 + y^2, which rounding blurs: it drops four of five sites as `coplanar`, without a word. A corner that
is subtracted first helps it, up to a few edges; dt3d is exact as it is. Look at the table, and at the roofs.

    python examples/lidar_tile.py --write out/lidar_tile.png
    python examples/lidar_tile.py --read tile.laz --write out/lidar_tile.png     # pip install "dt3d[formats]"
"""

import argparse
import time
from pathlib import Path

import numpy as np
import pyvista as pv
import scipy.spatial
from scipy.interpolate import LinearNDInterpolator

import dt3d
from dt3d.files import read_points
from dt3d.interpolate import Linear
from dt3d.threaded2d import verify

CORNER = np.array([500_000.0, 5_400_000.0])  # of the tile: a zone's middle meridian, in southern Germany
HOUSES = ((22, 24, 0.3), (50, 18, 0.3), (78, 30, 0.5), (26, 70, -0.2), (60, 80, -0.2))  # x, y, direction


def surface(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The height of a hill with a stream, gabled houses and trees, in metres."""
    z = (
        400
        + 4 * np.sin(x / 30)
        + 5 * np.cos(y / 40)
        - 4 * np.exp(-(((y - 50 - 6 * np.sin(x / 14)) / 4) ** 2))
    )
    ground = z.copy()
    for east, north, turn in HOUSES:
        u = (x - east) * np.cos(turn) + (y - north) * np.sin(turn)
        v = (y - north) * np.cos(turn) - (x - east) * np.sin(turn)
        floor = 400 + 4 * np.sin(east / 30) + 5 * np.cos(north / 40)
        z = np.where((np.abs(u) < 8) & (np.abs(v) < 5), floor + 8 - 0.7 * np.abs(v), z)
    for east, north, radius in np.random.default_rng(4).uniform((2, 2, 1.5), (98, 98, 4), (60, 3)):
        if min(np.hypot(east - h[0], north - h[1]) for h in HOUSES) > 11 + radius:
            crown = 1 - ((x - east) ** 2 + (y - north) ** 2) / radius**2
            z = np.where(crown > 0, np.maximum(z, ground + radius * (1 + 1.5 * np.sqrt(crown.clip(0)))), z)
    return z


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Triangulate a tile of a laser scan.")
    parser.add_argument("--points", type=int, default=100_000, help="of the tile that is made, 100 m wide")
    parser.add_argument("--read", type=Path, help="a .las or .laz file in place of it")
    parser.add_argument("--write", type=Path, default=Path("out/lidar_tile.png"))
    options = parser.parse_args(argv)

    if options.read is None:
        x, y = 100 * np.random.default_rng(0).random((2, options.points))
        points = np.column_stack([x + CORNER[0], y + CORNER[1], surface(x, y)]).round(2)
    else:
        points = read_points(options.read)
    sites, heights = points[:, :2], points[:, 2]
    corner = sites.min(axis=0)
    dt3d.Delaunay(sites[:100]).verify()  # the first call of a new machine compiles

    print(f"{len(sites):,} points, of which {len(np.unique(sites, axis=0)):,} differ in x and y\n")
    print(f"{'':26}{'seconds':>8}{'triangles':>11}{'sites used':>12}   Delaunay?")
    found = {}
    for name, delaunay, given in (
        ("SciPy", scipy.spatial.Delaunay, sites),
        ("SciPy, less the corner", scipy.spatial.Delaunay, sites - corner),
        ("dt3d", dt3d.Delaunay, sites),
    ):
        begun = time.perf_counter()
        tri = found[name] = delaunay(given)
        seconds, used = time.perf_counter() - begun, len(np.unique(tri.simplices))
        proof = str(verify(sites, tri.simplices)).splitlines()
        broken = next((line for line in proof if line.startswith("broken")), "proved")
        print(f"{name:26}{seconds:8.2f}{len(tri.simplices):11,}{used:12,}   {broken}")

    if options.read is None:
        x, y = 1 + 98 * np.random.default_rng(1).random((2, 100_000))
        asked = np.column_stack([x, y]) + CORNER
        print("\nheights at 100,000 other places, off the surface that the program has made:")
        for name, tri, method in (
            ("SciPy", found["SciPy"], LinearNDInterpolator),
            ("dt3d", found["dt3d"], Linear),
        ):
            off = np.abs(method(tri, heights)(asked) - surface(x, y))
            print(f"{name:26}{np.nanmean(off):8.3f} m on average")

    plotter = pv.Plotter(shape=(1, 2), off_screen=True, border=False, window_size=(1600, 800))
    plotter.set_background("white")
    low, high = heights.min(), heights.max()
    look = {"cmap": "gist_earth", "clim": (1.6 * low - 0.6 * high, high), "show_scalar_bar": False}
    middle = np.array([*(np.ptp(sites, axis=0) * (0.55, 0.3)), np.median(heights)])
    for panel, name in enumerate(("SciPy", "dt3d")):
        triangles = found[name].simplices
        plotter.subplot(0, panel)
        title = f"{name}: {len(np.unique(triangles)):,} of {len(sites):,} points"
        text = plotter.add_text(title, color="black", font_size=14)
        text.prop.background_color, text.prop.background_opacity = "white", 0.9
        mesh = pv.PolyData.from_regular_faces(np.column_stack([sites - corner, heights]), triangles)
        plotter.add_mesh(mesh, scalars=heights, show_edges=True, edge_opacity=0.25, **look)
        eye = middle + np.array([-0.25, -0.7, 0.55]) * np.ptp(sites[:, 0])
        plotter.camera_position = [eye, middle, (0, 0, 1)]
    plotter.enable_anti_aliasing("ssaa", all_renderers=True)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

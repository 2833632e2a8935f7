"""Tetrahedra cut open and blown apart, by PyVista: those behind a plane, and the same with gaps.

The left panel keeps the tetrahedra that lie behind a plane, none of them cut (`crinkle`), with the sites that
are no longer covered. In the right one each of them moves away from the middle (`explode`). Colours are the
iterations that found them: small tetrahedra come first, everywhere at once, the largest ones last.

    python examples/cut_open.py                          # writes out/cut_open.png, without a screen
    python examples/cut_open.py --window                 # a window to turn them in
"""

import argparse
from pathlib import Path

import numpy as np
import pyvista as pv

import dt3d


def ball(count: int, seed: int = 0) -> np.ndarray:
    """Sites at random in the unit ball, float64 (count, 3)."""
    rng = np.random.default_rng(seed)
    directions = rng.standard_normal((count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return directions * np.cbrt(rng.random((count, 1)))


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Draw the inside of a triangulation.")
    parser.add_argument("--sites", type=int, default=300)
    parser.add_argument("--explode", type=float, default=0.9, help="how far tetrahedra move apart")
    parser.add_argument("--write", type=Path, default=Path("out/cut_open.png"))
    parser.add_argument("--size", type=int, default=900, help="pixels of a panel")
    parser.add_argument("--window", action="store_true", help="open a window instead of writing a picture")
    options = parser.parse_args(argv)

    tri = dt3d.Delaunay(ball(options.sites), method="extrapolation")
    grid = tri.to_pyvista()  # an UnstructuredGrid with the cell data "iteration" and "volume"
    print(f"{options.sites:,} sites, {grid.n_cells:,} tetrahedra, found in {tri.stats.iterations} iterations")

    grid.point_data["site"] = np.arange(len(tri.points))
    cut = grid.clip(normal=(1, -1, 0.3), origin=grid.center, crinkle=True)
    blown = cut.explode(options.explode)
    last = tri.stats.iterations
    look = {
        "scalars": "iteration",
        "cmap": "viridis",
        "clim": (0.5, last + 0.5),
        "n_colors": last,
        "ambient": 0.15,
    }
    bar = {"title": "found in iteration", "fmt": "%.0f", "n_labels": 0, "color": "black", "vertical": False}
    names = {k: str(k) for k in range(1, last + 1)}

    plotter = pv.Plotter(shape=(1, 2), off_screen=not options.window, border=False)
    plotter.window_size = (2 * options.size, options.size)
    plotter.set_background("white")
    plotter.subplot(0, 0)
    plotter.add_mesh(cut, show_edges=True, edge_color="black", line_width=1.5, show_scalar_bar=False, **look)
    gone = np.setdiff1d(np.arange(len(tri.points)), cut.point_data["site"])
    plotter.add_points(tri.points[gone], color="black", point_size=6, render_points_as_spheres=True)
    plotter.subplot(0, 1)
    plotter.add_mesh(
        blown,
        show_edges=True,
        edge_color="gray",
        line_width=1,
        scalar_bar_args=bar,
        annotations=names,
        **look,
    )
    for panel in (0, 1):
        plotter.subplot(0, panel)
        plotter.camera_position = [(2.2, -1.5, 1.1), (0, 0, 0), (0, 0, 1)]
        plotter.reset_camera()
        plotter.camera.zoom(1.2)
    plotter.enable_anti_aliasing("ssaa", all_renderers=True)
    if options.window:
        plotter.show(title="dt3d")
        return
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"{options.write}: {cut.n_cells:,} tetrahedra behind the plane; the same, blown apart")


if __name__ == "__main__":
    main()

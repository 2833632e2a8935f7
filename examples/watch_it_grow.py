"""The triangulation as it grows: a panel for each iteration.

Every site starts with one facet, so the first panel shows small tetrahedra everywhere at once: nothing grows
from a corner. By the third the space between them is almost full, and the last iterations add a few large
tetrahedra, at the hull and in holes that are surrounded by earlier ones. Those that are new are orange.

    python examples/watch_it_grow.py --sites 800 --write out/watch_it_grow.png
    python examples/watch_it_grow.py --whole          # not cut open: the hull closes
"""

import argparse
from pathlib import Path

import numpy as np
import pyvista as pv

import dt3d


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Draw the tetrahedra found up to each iteration.")
    parser.add_argument("--sites", type=int, default=800)
    parser.add_argument("--write", type=Path, default=Path("out/watch_it_grow.png"))
    parser.add_argument("--whole", action="store_true", help="not cut open, to see the hull")
    parser.add_argument("--size", type=int, default=500, help="pixels of a panel's side")
    options = parser.parse_args(argv)

    points = np.random.default_rng(1).random((options.sites, 3))
    tri = dt3d.Delaunay(points, method="extrapolation")
    grid = tri.to_pyvista()
    if not options.whole:
        middles = points[tri.simplices].mean(axis=1)
        grid = grid.extract_cells((middles - 0.5) @ (0.6, -0.7, 0.25) < 0)  # what lies behind the middle
    counts = [count for count in tri.stats.tetrahedra_per_iteration if count]
    rows = 1 if len(counts) < 4 else 2
    columns = -(-len(counts) // rows)

    plotter = pv.Plotter(shape=(rows, columns), off_screen=True, border=False)
    plotter.window_size = (columns * options.size, rows * options.size)
    plotter.set_background("white")
    for iteration, new in enumerate(counts, start=1):
        title = f"iteration {iteration}: {new:,} new, {sum(counts[:iteration]):,} in all"
        print(title)
        plotter.subplot(*divmod(iteration - 1, columns))
        plotter.add_text(title, color="black", font_size=options.size // 42)
        for shown, color in (
            (grid.cell_data["iteration"] < iteration, "lightsteelblue"),
            (grid.cell_data["iteration"] == iteration, "darkorange"),
        ):
            if shown.any():
                part = grid.extract_cells(shown).shrink(0.85)
                plotter.add_mesh(part, color=color, ambient=0.25, show_edges=True, edge_color="dimgray")
        plotter.camera_position = [(2.45, -1.75, 1.35), (0.5, 0.5, 0.45), (0, 0, 1)]
        plotter.camera.zoom(1.15)
    plotter.enable_anti_aliasing("ssaa", all_renderers=True)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

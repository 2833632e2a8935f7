"""Scattered heights become a map: Crater Lake from a few thousand of its 154,224 points.

Linear interpolation is continuous, with creases along the edges of the triangles; natural neighbours (Sibson)
are smooth but for the sites themselves. Look at the errors printed, and at the shores in the picture.

    python examples/scattered_heights.py --kept 3000 --write out/scattered_heights.png
"""

import argparse
from pathlib import Path

import numpy as np
import pyvista as pv

from dt3d import samples
from dt3d.interpolate import Linear, NaturalNeighbor


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Interpolate scattered heights.")
    parser.add_argument("--kept", type=int, default=3000, help="points that are kept")
    parser.add_argument(
        "--step", type=int, default=1, help="of the grid of the map, in points of the terrain"
    )
    parser.add_argument("--write", type=Path, default=Path("out/scattered_heights.png"))
    options = parser.parse_args(argv)

    terrain = samples.crater_lake()
    columns, rows = terrain[:, :2].max(axis=0).astype(int) + 1
    corners = [0, columns - 1, (rows - 1) * columns, rows * columns - 1]  # so that the hull is the whole map
    rng = np.random.default_rng(0)
    kept = np.union1d(corners, rng.choice(len(terrain), options.kept, replace=False))
    sites, heights = terrain[kept, :2], terrain[kept, 2]

    step = options.step
    asked = terrain.reshape(rows, columns, 3)[::step, ::step]
    maps = {"kept points": None}
    for name, method in (("linear", Linear), ("natural neighbours", NaturalNeighbor)):
        maps[name] = method(sites, heights)(asked[..., :2])
        off = np.abs(maps[name] - asked[..., 2])
        print(
            f"{name:19} of {len(kept):,} points: {off.mean():.1f} m off on average, {off.max():.0f} m at most"
        )
    maps["the terrain itself"] = asked[..., 2]

    plotter = pv.Plotter(shape=(2, 2), off_screen=True, border=False, window_size=(1600, 1200))
    plotter.set_background("white")
    look = {"cmap": "terrain", "clim": (heights.min(), heights.max()), "show_scalar_bar": False}
    for k, (name, z) in enumerate(maps.items()):
        plotter.subplot(*divmod(k, 2))
        plotter.add_text(name, color="black", font_size=14)
        if z is None:
            cloud = pv.PolyData(np.column_stack([sites, heights / 8]))
            plotter.add_mesh(cloud, scalars=heights, point_size=4, **look)
        else:
            surface = pv.StructuredGrid(asked[..., 0], asked[..., 1], z / 8)
            plotter.add_mesh(surface, scalars=z.ravel(order="F"), smooth_shading=True, **look)
        plotter.camera_position = [
            (columns / 2, -1.1 * rows, 1.5 * rows),
            (columns / 2, rows / 2, 200),
            (0, 0, 1),
        ]
        plotter.camera.zoom(1.35)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

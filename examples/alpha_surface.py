"""The surface of a cloud of points: the alpha shape of a knotted tube, and its topology.

With alpha about the spacing of the points the shape is the tube: a solid torus, knotted, whose surface has an
Euler characteristic of 0. Larger alpha fills the gaps between its windings, smaller alpha makes holes. Look
at the three panels, and at the characteristic of each.

    python examples/alpha_surface.py --points 20000 --write out/alpha_surface.png
"""

import argparse
from pathlib import Path

import numpy as np
import pyvista as pv

import dt3d


def knot(count: int, seed: int = 0) -> np.ndarray:
    """Points at random in a tube around a trefoil knot, float64 (count, 3)."""
    rng = np.random.default_rng(seed)
    t = rng.uniform(0, 2 * np.pi, count)
    centre = np.column_stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)])
    offset = rng.standard_normal((count, 3))
    offset *= 0.45 * np.cbrt(rng.random((count, 1))) / np.linalg.norm(offset, axis=1)[:, None]
    return centre + offset


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Draw alpha shapes of a knotted tube.")
    parser.add_argument("--points", type=int, default=20_000)
    parser.add_argument("--write", type=Path, default=Path("out/alpha_surface.png"))
    options = parser.parse_args(argv)

    tri = dt3d.Delaunay(knot(options.points))
    spacing = np.cbrt(15 / options.points)  # the tube has a volume of about 15
    plotter = pv.Plotter(shape=(1, 3), off_screen=True, border=False, window_size=(2100, 700))
    plotter.set_background("white")
    for k, alpha in enumerate((0.75 * spacing, 1.6 * spacing, 0.8)):
        shape = tri.alpha_shape(alpha)
        facets = shape.boundary
        edges = np.unique(np.sort(facets[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
        characteristic = len(np.unique(facets)) - len(edges) + len(facets)
        title = f"alpha {alpha:.2f}: volume {shape.volumes.sum():.1f}, Euler characteristic {characteristic}"
        print(title)
        plotter.subplot(0, k)
        plotter.add_text(title, color="black", font_size=10)
        surface = pv.PolyData.from_regular_faces(tri.points, facets)
        plotter.add_mesh(surface, color="lightsteelblue", specular=0.3, split_sharp_edges=True)
        plotter.camera_position = [(0, 0, 14), (0, 0, 0), (0, 1, 0)]
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

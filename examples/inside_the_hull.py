"""Which of many points lie in the convex hull of sites? The known recipe, and its points on the border.

`Delaunay(sites).find_simplex(points) >= 0` is the recipe. The sites are a crystal's: those of a lattice
within a truncated octahedron. The points asked for are a finer lattice, so that many lie exactly on a face,
and belong to the hull; then these are moved out by one unit in the last place, and do not. Integers know the
truth. Look at the seconds, and at the last column: SciPy has a tolerance, dt3d decides exactly.

    python examples/inside_the_hull.py --size 6 --write out/inside_the_hull.png
"""

import argparse
import time
from itertools import product
from pathlib import Path

import numpy as np
import pyvista as pv
import scipy.spatial

import dt3d


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Test points for a convex hull.")
    parser.add_argument("--size", type=int, default=6, help="of the crystal, an even number of lattice steps")
    parser.add_argument("--write", type=Path, default=Path("out/inside_the_hull.png"))
    options = parser.parse_args(argv)

    size = options.size
    lattice = np.array(list(product(range(-2 * size - 2, 2 * size + 3), repeat=3)))  # in halves of a step
    excess = np.maximum(np.abs(lattice).max(axis=1) - 2 * size, np.abs(lattice).sum(axis=1) - 3 * size)
    sites = lattice[(excess <= 0) & (lattice % 2 == 0).all(axis=1)] / 2
    points, on = lattice / 2, excess == 0
    beyond = np.nextafter(
        points[on], np.copysign(np.inf, points[on])
    )  # one unit in the last place further out

    tri = dt3d.Delaunay(sites)
    tri.find_simplex(points[:1])  # the first call of a new machine compiles
    print(f"{len(sites):,} sites; {len(points):,} points, {on.sum():,} of them exactly on a face\n")
    print(f"{'':8}{'seconds':>9}{'inside':>9}{'wrong':>7}{'a hair outside: wrong':>24}")
    for name, delaunay in (("SciPy", scipy.spatial.Delaunay), ("dt3d", dt3d.Delaunay)):
        begun = time.perf_counter()
        tri = delaunay(sites)
        inside = tri.find_simplex(points) >= 0
        seconds = time.perf_counter() - begun
        wrong, hair = (
            np.count_nonzero(inside != (excess <= 0)),
            np.count_nonzero(tri.find_simplex(beyond) >= 0),
        )
        print(f"{name:8}{seconds:9.3f}{inside.sum():9,}{wrong:7,}{hair:14,} of {len(beyond):,}")

    many = np.random.default_rng(0).uniform(-size - 1, size + 1, (1_000_000, 3))
    begun = time.perf_counter()
    share = np.count_nonzero(tri.find_simplex(many) >= 0) / len(many)
    seconds, volume = time.perf_counter() - begun, tri.volumes.sum() / (2 * size + 2) ** 3
    print(f"\ndt3d, a million other points: {seconds:.2f} s, {share:.4f} inside; by volume {volume:.4f}")

    depth = points[:, 1] - points[:, 0]  # behind a layer of the lattice, to see inside
    plotter = pv.Plotter(off_screen=True, window_size=(1500, 1000))
    plotter.set_background("white")
    hull = tri.hull_to_pyvista()
    plotter.add_mesh(hull, color="steelblue", opacity=0.1)
    plotter.add_mesh(hull.extract_feature_edges(20), color="black", line_width=3)
    for name, cloud, color, pixels in (
        ("inside", points[(excess < 0) & (depth >= 0)], "steelblue", 170),
        ("on a face: inside, too", points[on & (depth >= 0)], "orange", 170),
        ("outside", points[(excess > 0) & (depth == 0)], "gray", 60),
    ):
        plotter.add_points(
            cloud, color=color, point_size=pixels / size, render_points_as_spheres=True, label=name
        )
    plotter.add_legend(
        face="circle", bcolor="white", background_opacity=0.8, size=(0.24, 0.14), loc="upper left"
    )
    plotter.camera_position = [(2.5 * size, -3.25 * size, 1.25 * size), (0, 0, 0), (0, 0, 1)]
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

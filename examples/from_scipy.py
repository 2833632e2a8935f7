"""One import changed: what is done with `scipy.spatial.Delaunay`, by it and by `dt3d.Delaunay`.

The function below is a user's, word for word, and gets the class. Look at the seconds, and at the last lines:
a grid has sites on common spheres, where SciPy has flat tetrahedra, in which weights are noise. The picture
has them in red.

    python examples/from_scipy.py 20000 --write out/from_scipy.png
"""

import argparse
import time
from pathlib import Path

import numpy as np
import pyvista as pv
import scipy.spatial
from scipy.interpolate import LinearNDInterpolator

import dt3d


def user(delaunay: type, points: np.ndarray, queries: np.ndarray) -> dict[str, np.ndarray]:
    """Locate, test for the hull, weigh and interpolate: what is written with SciPy's class."""
    tri = delaunay(points)
    simplex = tri.find_simplex(queries)
    inside = simplex >= 0
    transform = tri.transform[simplex[inside]]
    first = np.einsum("ijk,ik->ij", transform[:, :3], queries[inside] - transform[:, 3])
    weights = np.column_stack([first, 1 - first.sum(axis=1)])
    values = (weights * np.sin(points).sum(axis=1)[tri.simplices[simplex[inside]]]).sum(axis=1)
    return {"inside": inside, "hull": np.unique(tri.convex_hull), "values": values}


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Run the same code with both classes.")
    parser.add_argument("sites", nargs="?", type=int, default=20_000)
    parser.add_argument("--write", type=Path, default=Path("out/from_scipy.png"))
    options = parser.parse_args(argv)

    sites = options.sites
    rng = np.random.default_rng(0)
    points, queries = rng.random((sites, 3)), rng.random((sites, 3)) * 1.1
    dt3d.Delaunay(points[:9]).find_simplex(queries[:1])  # the first call of a new machine compiles
    found = {}
    for module, delaunay in (("scipy.spatial", scipy.spatial.Delaunay), ("dt3d", dt3d.Delaunay)):
        begun = time.perf_counter()
        found[module] = user(delaunay, points, queries)
        print(f"{module:14} {time.perf_counter() - begun:.3f} s")
    ours, theirs = found["dt3d"], found["scipy.spatial"]
    print("same points inside:", np.array_equal(ours["inside"], theirs["inside"]))
    print("same sites on the hull:", np.array_equal(ours["hull"], theirs["hull"]))
    print(f"values differ by {np.abs(ours['values'] - theirs['values']).max():.1e} at most")

    tri = dt3d.Delaunay(points)
    interpolator = LinearNDInterpolator(tri.to_scipy(), points[:, 0])  # what asks for SciPy's own class
    print("LinearNDInterpolator of to_scipy() at the centre:", interpolator(0.5, 0.5, 0.5).round(12))

    grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3), axis=-1).reshape(-1, 3)
    plotter = pv.Plotter(shape=(1, 2), off_screen=True, border=False, window_size=(1500, 750))
    plotter.set_background("white")
    for panel, (module, delaunay) in enumerate(
        (("scipy.spatial", scipy.spatial.Delaunay), ("dt3d", dt3d.Delaunay))
    ):
        simplices = delaunay(grid).simplices
        corners = grid[simplices]
        flat = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6 < 1e-12
        title = f"a grid of 6 x 6 x 6: {np.count_nonzero(flat)} flat of {len(flat)} tetrahedra"
        print(f"{module:14} {title}")
        plotter.subplot(0, panel)
        plotter.add_text(f"{module}, {title}", color="black", font_size=12)
        mesh = pv.UnstructuredGrid({pv.CellType.TETRA: simplices}, grid)
        plotter.add_mesh(mesh.extract_cells(~flat).shrink(0.7), color="lightsteelblue")
        if flat.any():
            plotter.add_mesh(mesh.extract_cells(flat), color="crimson", ambient=0.4)
        plotter.camera_position = [(15, -11, 9), (2.5, 2.5, 2.4), (0, 0, 1)]
        plotter.camera.zoom(1.25)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

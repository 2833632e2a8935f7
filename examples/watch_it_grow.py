"""The triangulation as it grows: one picture an iteration, in a folder.

Every site starts with one facet, so the first picture shows small tetrahedra everywhere at once: nothing
grows from a corner. By the third the space between them is almost full, and the last iterations add a few
large tetrahedra, at the hull and in holes that are surrounded by earlier ones.

    python examples/watch_it_grow.py --sites 1500 --folder out/growth
"""

import argparse
from pathlib import Path

import numpy as np

import dt3d
from dt3d.plot import View, draw


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Draw the tetrahedra found up to each iteration.")
    parser.add_argument("--sites", type=int, default=1500)
    parser.add_argument("--folder", type=Path, default=Path("out/growth"))
    parser.add_argument("--cut", action="store_true", help="cut open, to see inside")
    parser.add_argument("--size", type=int, default=900, help="pixels of a side")
    options = parser.parse_args(argv)
    options.folder.mkdir(parents=True, exist_ok=True)

    points = np.random.default_rng(1).random((options.sites, 3))
    tri = dt3d.Delaunay(points, method="extrapolation")

    found = 0
    for iteration, new in enumerate(tri.stats.tetrahedra_per_iteration, start=1):
        found += new
        title = f"after iteration {iteration}: {found:,} tetrahedra, {new:,} of them new"
        path = options.folder / f"iteration_{iteration:02d}.png"
        view = View(title, shrink=0.75, cut=options.cut, upto=iteration)
        draw(tri, path, view, width=options.size, height=options.size)
        print(f"{path}: {title}")


if __name__ == "__main__":
    main()

"""Threads that triangulate the plane together: who made which triangles, and what they had to wait for.

Look at the colours: with slabs each thread works in its own, and they meet at the borders; at random all of
them work everywhere. The triangles are the same; the picture has all three ways to share sites. Then look
at the counts: circum-circle tests are made for every change, though waits are rare, unless there are few
sites for many threads.

    python examples/threads_in_the_plane.py 20000 --threads 4 --subdivision x-slabs --write threads.png
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dt3d import threaded2d

SUBDIVISIONS = ("random", "x-slabs", "distance")


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description="Triangulate random sites in the unit square by several threads."
    )
    parser.add_argument("sites", nargs="?", type=int, default=5000)
    parser.add_argument("--threads", type=int, default=4)
    parser.add_argument("--subdivision", choices=SUBDIVISIONS, default="x-slabs")
    parser.add_argument("--write", type=Path, help="a picture, by its extension")
    options = parser.parse_args(argv)

    points = np.random.default_rng(0).random((options.sites, 2))
    want = {frozenset(t) for t in threaded2d.Delaunay(points, method="sequential").triangles.tolist()}
    for method in ("batch", "circumcircle", "optimistic"):
        tri = threaded2d.Delaunay(
            points, method=method, threads=options.threads, subdivision=options.subdivision, order="random"
        )
        same = {frozenset(t) for t in tri.triangles.tolist()} == want
        s = tri.stats
        print(
            f"{method}: {len(tri.triangles)} triangles, {'the same' if same else 'OTHERS'} as by one thread"
        )
        print(f"    inserted {s.inserted}, waits {s.waits}, begun again {s.retries}")
        print(f"    {s.tests_per_access:.1f} tests per change, {s.exceptions} deadlocks resolved")

    if options.write is not None:
        figure = Figure(figsize=(11, 4), layout="constrained")
        for axes, subdivision in zip(figure.subplots(1, 3), SUBDIVISIONS, strict=True):
            tri = threaded2d.Delaunay(
                points,
                method="circumcircle",
                threads=options.threads,
                subdivision=subdivision,
                order="random",
            )
            tri.plot(axes)
            axes.set_title(f"parts: {subdivision}")
            axes.set_axis_off()
        figure.savefig(options.write, dpi=100)
        print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

"""Threads that triangulate the plane together: who made which triangles, and what they had to wait for.

Look at the colours: with slabs each thread works in its own, and they meet at the borders; at random all of
them work everywhere. The triangles are the same. Then look at the counts: circum-circle tests are made for
every change, though waits are rare, unless there are few sites for many threads.

    python examples/threads_in_the_plane.py 20000 --threads 4 --subdivision x-slabs --write threads.png
"""

import argparse
from pathlib import Path

import numpy as np

from dt3d import threaded2d
from dt3d.plot import save_figure


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description="Triangulate random sites in the unit square by several threads."
    )
    parser.add_argument("sites", nargs="?", type=int, default=5000)
    parser.add_argument("--threads", type=int, default=4)
    parser.add_argument("--subdivision", choices=["random", "x-slabs", "distance"], default="x-slabs")
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
        save_figure(tri.plot().figure, options.write)
        print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

"""The first thing to try: random sites, their Delaunay tetrahedra, and what was counted on the way.

Look at the last lines. It takes about three face expansions to make two tetrahedra, since a tetrahedron is
often found from several sides at once; and a face is expanded by searching a number of sites that does not
grow with the size of the set. Run it with 4000 sites, then with 8000, and compare.

    python examples/first_triangulation.py 4000 --write sites.png     (or sites.vtu, for PyVista and ParaView)
"""

import argparse
from pathlib import Path

import numpy as np

import dt3d
from dt3d.files import write_mesh


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Triangulate random sites in the unit cube.")
    parser.add_argument("sites", nargs="?", type=int, default=2000)
    parser.add_argument("--write", type=Path, help="a picture or a mesh, by its extension")
    options = parser.parse_args(argv)

    points = np.random.default_rng(0).random((options.sites, 3))
    # as Teng et al. 1993 have it: QR decomposition, random perturbation, check of consistency
    tri = dt3d.Delaunay(points, preset="teng1993")

    a, b, c, d = tri.points[tri.simplices[0]]
    volume = np.linalg.det([b - a, c - a, d - a]) / 6
    print(f"{len(tri.points)} sites, {len(tri.simplices)} tetrahedra, {len(tri.convex_hull)} hull faces")
    print(f"the first tetrahedron has the sites {tri.simplices[0]} and volume {volume:.2e}")
    print(f"its neighbours are {tri.neighbors[0]}, where {dt3d.OUTSIDE} is the outside")
    stats = tri.stats
    print(f"{stats.iterations} iterations found {' + '.join(map(str, stats.tetrahedra_per_iteration))}")
    print(f"{stats.face_expansions / len(tri.simplices):.2f} face expansions a tetrahedron")
    print(f"{stats.sites_searched / stats.face_expansions:.1f} sites searched a face expansion")
    print(f"{stats.cells_opened / stats.face_expansions:.1f} cells opened a face expansion")
    print(f"{stats.inconsistencies} inconsistencies")

    if options.write is not None:
        if options.write.suffix in (".png", ".jpg"):
            # long tetrahedra along the hull would hide the rest
            plotter = tri.plot(scalars="iteration", longest=0.5, off_screen=True, window_size=(1300, 1000))
            plotter.camera.zoom(0.9)
            plotter.screenshot(options.write)
        else:
            write_mesh(tri, options.write)
        print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

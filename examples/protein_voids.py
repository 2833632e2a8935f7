"""Voids within a protein: where a ball of water size fits and cannot get out, by alpha shapes of the atoms.

A tetrahedron whose circumsphere is larger than an atom and a ball of water together has room for the ball.
Such tetrahedra are joined where the ball fits through the facet between them, too. A component that does not
reach the outside is a void (H. Edelsbrunner, E. P. Mücke: Three-dimensional Alpha Shapes, ACM Transactions on
Graphics 13, 1994). Look at the largest ones in the picture, each in a colour, within the pale protein.

    python examples/protein_voids.py --radius 3.2 --write out/protein_voids.png
"""

import argparse
from pathlib import Path

import numpy as np
import pyvista as pv
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import dt3d
from dt3d import samples


def circles(points: np.ndarray, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The centre and the radius of the circle around each triangle, float64 (h, 3) and (h,)."""
    a, u, v = points[facets[:, 0]], *(points[facets[:, k]] - points[facets[:, 0]] for k in (1, 2))
    uu, vv, uv = (np.einsum("ij,ij->i", p, q) for p, q in ((u, u), (v, v), (u, v)))
    s, t = np.array([vv * (uu - uv), uu * (vv - uv)]) / (2 * (uu * vv - uv * uv))
    centre = s[:, None] * u + t[:, None] * v
    return a + centre, np.linalg.norm(centre, axis=1)


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Find the voids within a protein.")
    parser.add_argument("--radius", type=float, default=3.2, help="of an atom and a ball, in ångström")
    parser.add_argument("--atoms", type=int, help="only so many, for a quick look")
    parser.add_argument("--write", type=Path, default=Path("out/protein_voids.png"))
    options = parser.parse_args(argv)

    tri = dt3d.Delaunay(samples.mtor()[: options.atoms])
    m = len(tri.simplices)
    roomy = tri.circumradii > options.radius
    rows, columns, outside = [], [], m  # the outside is one more node
    for k in range(4):
        centre, radius = circles(tri.points, np.delete(tri.simplices, k, axis=1))
        opposite = tri.points[tri.simplices[:, k]]
        # on its way between two obtuse tetrahedra the ball comes no nearer to the atoms than at its ends
        obtuse = np.linalg.norm(opposite - centre, axis=1) < radius
        beyond = np.where(tri.neighbors[:, k] == dt3d.OUTSIDE, outside, tri.neighbors[:, k])
        joined = roomy & np.append(roomy, True)[beyond] & (obtuse | (radius > options.radius))
        rows.append(np.flatnonzero(joined))
        columns.append(beyond[joined])
    rows, columns = np.concatenate(rows), np.concatenate(columns)
    graph = coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(m + 1, m + 1))
    _, component = connected_components(graph, directed=False)
    void = roomy & (component[:m] != component[outside])
    labels, number = np.unique(component[:m][void], return_inverse=True)
    sizes = np.bincount(number, weights=tri.volumes[void], minlength=len(labels))
    order = np.argsort(-sizes)
    print(
        f"{len(tri.points):,} atoms, {m:,} tetrahedra; "
        f"{len(labels)} voids of {sizes.sum():,.0f} cubic ångström"
    )
    print("the largest:", ", ".join(f"{size:.0f}" for size in sizes[order[:6]]))

    plotter = pv.Plotter(off_screen=True, window_size=(1300, 900))
    plotter.set_background("white")
    body = pv.PolyData.from_regular_faces(tri.points, tri.alpha_shape(2 * options.radius).boundary)
    plotter.add_mesh(body, color="wheat", opacity=0.15)
    colors = ("crimson", "royalblue", "seagreen", "darkorange", "purple", "teal")
    for color, which in zip(colors, order, strict=False):
        mask = np.zeros(m, bool)
        mask[np.flatnonzero(void)[number == which]] = True
        plotter.add_mesh(pv.PolyData.from_regular_faces(tri.points, tri.boundary(mask)), color=color)
    plotter.camera_position = "xz"
    plotter.camera.zoom(1.3)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

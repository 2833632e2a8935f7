"""What numba compiles for each kind of call, by calling it on small sets; `dt3d warmup` runs all of it.

What is compiled stays on disk, so that later processes load it in milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

SITES = 2000  # enough for several threads
MANY = 30_000  # from here on queries are located along a curve


def _sites(d: int, n: int = SITES) -> np.ndarray:
    return np.random.default_rng(0).random((n, d))


def _grid(d: int) -> np.ndarray:
    """Sites that leave much to the exact stages."""
    return np.stack(np.meshgrid(*[np.arange(8.0)] * d), -1).reshape(-1, d)


def triangulations_in_space() -> None:
    """`dt3d.Delaunay` of points in space."""
    import dt3d

    for sites in (_sites(3), _grid(3), _sites(3, MANY)):
        dt3d.Delaunay(sites)


def triangulations_in_the_plane() -> None:
    """`dt3d.Delaunay` of points in the plane, located and proved."""
    import dt3d

    for sites in (_grid(2), _sites(2, MANY), _sites(2)):
        tri = dt3d.Delaunay(sites)
    tri.find_simplex(_sites(2))
    tri.verify()


def queries() -> None:
    """`find_simplex`, `barycentric` and the neighbours of vertices in space."""
    import dt3d

    tri = dt3d.Delaunay(_sites(3))
    tri.find_simplex(_sites(3, 100))
    tri.find_simplex(_sites(3, MANY))
    tri.barycentric(_sites(3, 100))
    assert len(tri.vertex_neighbor_vertices) == 2
    assert len(tri.vertex_to_simplex) == SITES


def proofs() -> None:
    """`verify` in space."""
    import dt3d

    dt3d.Delaunay(_sites(3)).verify()


def sizes_and_cells() -> None:
    """Volumes, circumcenters, alpha shapes and Voronoi cells, in space and in the plane."""
    import dt3d
    from dt3d._cell_data import cell_data

    for d in (3, 2):
        tri = dt3d.Delaunay(_sites(d))
        cell_data(tri)
        tri.alpha_shape(0.1)
        assert len(dt3d.Voronoi(_sites(d)).volumes) == SITES


def interpolation() -> None:
    """The classes of `dt3d.interpolate`, in space and in the plane."""
    import dt3d.interpolate as interpolate

    for d in (3, 2):
        sites = _sites(d)
        for kind in (interpolate.Linear, interpolate.NaturalNeighbor, interpolate.Nearest):
            kind(sites, sites[:, 0])(_sites(d, 100))


def methods_of_kohout() -> None:
    """The methods of `dt3d.threaded2d`."""
    from dt3d import threaded2d

    threaded2d.Delaunay(_sites(2), method="sequential")
    threaded2d.Delaunay(_sites(2), method="batch", threads=2)
    threaded2d.Delaunay(_sites(2), method="circumcircle", threads=2)
    threaded2d.Delaunay(_sites(2), method="pessimistic", threads=2)
    threaded2d.Delaunay(_sites(2), method="optimistic", threads=2)


FIRST = triangulations_in_space
"""What most of the others need, too."""

OTHERS: tuple[Callable[[], None], ...] = (
    triangulations_in_the_plane,
    queries,
    sizes_and_cells,
    proofs,
    interpolation,
    methods_of_kohout,
)
"""What several processes may compile side by side."""

"""Pictures and meshes of triangles, coloured by thread."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from dt3d import samples, threaded2d

from .families import uniform


def test_to_pyvista():
    tri = threaded2d.Delaunay(uniform(300), method="optimistic", threads=3)
    mesh = tri.to_pyvista()
    np.testing.assert_array_equal(mesh.regular_faces, tri.triangles)
    np.testing.assert_array_equal(mesh.points[:, :2].astype(float), tri.points.astype(mesh.points.dtype))
    np.testing.assert_array_equal(mesh.cell_data["thread"], tri.thread)
    (x0, y0), (x1, y1) = (tri.points[tri.convex_hull[:, k]].T for k in (0, 1))
    assert mesh.area == pytest.approx(0.5 * (x0 * y1 - x1 * y0).sum(), rel=1e-5)


def test_plot_on_given_and_on_new_axes():
    tri = threaded2d.Delaunay(uniform(100), method="circumcircle", threads=2)
    ax = Figure().add_subplot()
    assert tri.plot(ax) is ax
    assert len(ax.collections[0].get_paths()) == len(tri.triangles)
    new = tri.plot()
    assert new is not ax
    assert len({tuple(c) for c in new.collections[0].get_facecolor()}) == len(np.unique(tri.thread))


def test_crater_lake():
    terrain = samples.crater_lake()
    assert terrain.shape == (154_224, 3)
    assert terrain.min(axis=0).tolist() == [0, 0, 1533]
    assert terrain.max(axis=0).tolist() == [335, 458, 2478]
    tri = threaded2d.Delaunay(terrain[:, :2])
    assert len(tri.triangles) == 2 * 335 * 458
    assert tri.verify(), tri.verify()

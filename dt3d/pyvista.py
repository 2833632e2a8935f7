"""The accessor ``dt3d`` of PyVista's datasets: ``cloud.dt3d.delaunay()``.

From PyVista 0.48 on, where dt3d is installed, datasets have it without an import: PyVista finds this module
by its entry point when a dataset is first asked for ``dt3d``. ``import dt3d.pyvista`` registers it, too.

Results have the points of the dataset, with their numbers and all of its point data.

>>> import numpy as np, pyvista as pv, dt3d.pyvista
>>> cloud = pv.PolyData(np.random.default_rng(0).random((50, 3)))
>>> cloud["temperature"] = np.arange(50.0)
>>> grid = cloud.dt3d.delaunay()
>>> grid.n_points, grid.active_scalars_name, grid.cell_data.keys()
(50, 'temperature', ['volume', 'longest_edge', 'circumradius', 'depth'])
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from ._optional import optional

if TYPE_CHECKING:
    import pyvista

    from .delaunay import Delaunay


class Accessor:
    """What ``dataset.dt3d`` is.

    Parameters
    ----------
    dataset : pyvista.DataSet
        Any dataset with points.
    """

    def __init__(self, dataset: pyvista.DataSet) -> None:
        self._dataset = dataset

    # Any: the options of `dt3d.Delaunay`, which checks them
    def triangulation(self, **options: Any) -> Delaunay:
        """The triangulation in space of the dataset's points.

        Parameters
        ----------
        **options
            Those of `dt3d.Delaunay`.

        Raises
        ------
        ValueError, TypeError, DegenerateInputError
            As `dt3d.Delaunay` says.

        Examples
        --------
        >>> import pyvista as pv, dt3d.pyvista
        >>> pv.ImageData(dimensions=(3, 3, 3)).dt3d.triangulation()
        <dt3d.Delaunay: 27 sites, 48 tetrahedra>
        """
        from .delaunay import Delaunay

        return Delaunay(self._dataset, **options)

    def delaunay(self, *, alpha: float | None = None, **options: Any) -> pyvista.UnstructuredGrid:
        """The tetrahedra of the dataset's points, with its point data, as PyVista's ``delaunay_3d``; exact.

        Parameters
        ----------
        alpha : float, optional
            A radius above 0: only tetrahedra whose circumscribed sphere has a radius of at most alpha. Unlike
            ``delaunay_3d``, there are no triangles, edges and vertices beside them.
        **options
            Those of `dt3d.Delaunay`.

        Returns
        -------
        pyvista.UnstructuredGrid
            As `dt3d.Delaunay.to_pyvista` makes it. Points that no tetrahedron uses are there, too.

        Raises
        ------
        ValueError, TypeError, DegenerateInputError
            As `dt3d.Delaunay` says, and if alpha is negative or no number.

        Examples
        --------
        >>> import pyvista as pv, dt3d.pyvista
        >>> ball = pv.SolidSphere()
        >>> ball.dt3d.delaunay().n_points == ball.n_points
        True
        """
        tri = self.triangulation(**options)
        part = tri if alpha is None else tri.alpha_shape(alpha)
        return cast("pyvista.UnstructuredGrid", part.to_pyvista(self._dataset))

    def delaunay_2d(self, *, alpha: float | None = None, **options: Any) -> pyvista.PolyData:
        """The triangles of the points seen from above, at their heights: a terrain; exact.

        As PyVista's ``delaunay_2d``: the triangulation is that of x and y alone.

        Parameters
        ----------
        alpha : float, optional
            Only triangles whose circumscribed circle, in x and y, has a radius of at most alpha.
        **options
            Those of `dt3d.Delaunay` in the plane.

        Returns
        -------
        pyvista.PolyData
            As `dt3d.Delaunay.to_pyvista` makes it; cell data are those of the triangles in the plane.

        Raises
        ------
        ValueError, TypeError, DegenerateInputError
            As `dt3d.Delaunay` says, and if alpha is negative or no number.

        Examples
        --------
        >>> import pyvista as pv, dt3d.pyvista
        >>> surface = pv.Plane(i_resolution=2, j_resolution=2).dt3d.delaunay_2d()
        >>> surface.n_points, surface.n_cells
        (9, 8)
        """
        from .delaunay import Delaunay

        tri = Delaunay(self._dataset.points[:, :2], **options)
        part = tri if alpha is None else tri.alpha_shape(alpha)
        return cast("pyvista.PolyData", part.to_pyvista(self._dataset))


def register() -> None:
    """Give all datasets of PyVista the accessor; it is called when this module is imported.

    Raises
    ------
    ImportError
        If PyVista is not installed, or older than 0.48, which has no accessors.
    """
    pv = optional("pyvista", "dt3d.pyvista")
    if not hasattr(pv, "register_dataset_accessor"):
        msg = (
            f"PyVista {pv.__version__} has no accessors, which came with 0.48; update it, or use "
            "dt3d.Delaunay(dataset).to_pyvista(dataset)"
        )
        raise ImportError(msg)
    pv.register_dataset_accessor("dt3d", pv.DataSet)(Accessor)


register()

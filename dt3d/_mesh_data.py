"""What a mesh of PyVista is given beside points and cells: data of cells, and the point data of a source."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._cell_data import varies

if TYPE_CHECKING:
    import pyvista


def check_source(source: object, n: int) -> None:
    """A ValueError, unless this is None or a dataset of PyVista with n points."""
    if source is None:
        return
    if not hasattr(source, "n_points") or not hasattr(source, "point_data"):
        msg = (
            f"source must be a dataset of PyVista, got a {type(source).__name__}; its point data are taken; "
            "for arrays: grid = tri.to_pyvista(); grid.point_data[name] = array"
        )
        raise ValueError(msg)
    if source.n_points != n:
        msg = (
            f"source has {source.n_points} points, and the triangulation has {n}; "
            "pass the dataset whose points were triangulated"
        )
        raise ValueError(msg)


def heights_of(source: pyvista.DataSet | None, n: int) -> np.ndarray:
    """The third coordinates of a source's points, float64 (n,); 0 without one."""
    return np.zeros(n) if source is None else np.array(source.points[:, 2], np.float64)


def carry(
    mesh: pyvista.DataSet,
    cells: dict[str, np.ndarray],
    source: pyvista.DataSet | None = None,
    rows: np.ndarray | None = None,
) -> None:
    """Give a mesh cell data, and the point data of a source; make active what tells most at first sight.

    Parameters
    ----------
    mesh : pyvista.DataSet
        What gets the data.
    cells : dict
        Arrays by name.
    source : pyvista.DataSet, optional
        Checked by `check_source`.
    rows : int (k,), optional
        The source's number of each point of the mesh, if these are not all.
    """
    for name, values in cells.items():
        mesh.cell_data[name] = values
    active = None
    if source is not None:
        active = source.point_data.active_scalars_name
        for name, values in source.point_data.items():
            mesh.point_data[name] = np.array(values) if rows is None else np.array(values)[rows]
    if active is not None and varies(np.asarray(mesh.point_data[active])):
        mesh.set_active_scalars(active, preference="point")
        return
    # not the depth, which is 0 all over the hull; that is seen first
    names = [name for name in ("longest_edge", "circumradius", "volume", "area", "depth") if name in cells]
    if names:
        telling = next((name for name in names if varies(cells[name])), names[0])
        mesh.set_active_scalars(telling, preference="cell")

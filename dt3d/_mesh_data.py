"""What a mesh is given beside points and cells: data of cells, and of points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np

from ._cell_data import varies

if TYPE_CHECKING:
    import pyvista

T = TypeVar("T")


@dataclass(frozen=True)
class Content(Generic[T]):
    """What is written into a file, and how.

    Attributes
    ----------
    tri : Delaunay, Subset or threaded2d.Delaunay
        The triangulation.
    point_data : mapping of str to (n, ...) arrays
        Data of its sites.
    compress : bool
        Whether the file is to be small rather than soon there.
    """

    tri: T
    point_data: Mapping[str, np.ndarray] = field(default_factory=dict)
    compress: bool = False


def check_point_data(point_data: Mapping[str, np.ndarray], n: int) -> dict[str, np.ndarray]:
    """The arrays, if each has an entry per site; otherwise a ValueError."""
    found = {name: np.asarray(values) for name, values in point_data.items()}
    for name, values in found.items():
        if values.shape[:1] != (n,):
            msg = (
                f"point data {name!r} must have an entry for each of the {n} sites, got shape {values.shape}"
            )
            raise ValueError(msg)
    return found


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
    if telling := telling_of(cells):
        mesh.set_active_scalars(telling, preference="cell")


def telling_of(cells: Mapping[str, np.ndarray]) -> str:
    """The name of the cell data that say most at first sight; empty if there are none.

    Not the depth, which is 0 all over the hull; that is seen first.
    """
    names = [name for name in ("longest_edge", "circumradius", "volume", "area", "depth") if name in cells]
    return next((name for name in names if varies(cells[name])), names[0] if names else "")

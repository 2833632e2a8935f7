"""The alpha complex: the simplices of a triangulation, of every dimension, with their filtration values.

H. Edelsbrunner, E. P. Muecke: Three-dimensional alpha shapes. ACM Transactions on Graphics 13, 1994. Values
are those of GUDHI's ``AlphaComplex``: squared radii.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ._results import frozen
from ._topology import OUTSIDE

if TYPE_CHECKING:
    import scipy.sparse

    from .delaunay import Delaunay


class AlphaComplex:
    """Simplices of dimension 0 to d with the squared radii at which they appear.

    A simplex appears with the smallest empty sphere through its vertices: its own smallest circumscribed
    sphere, if no vertex of a simplex that it bounds lies inside (it is a Gabriel simplex), else with the
    first of those that it bounds. So no simplex has a greater value than one that it bounds, rounding
    included.

    Attributes
    ----------
    simplices : tuple of int32 (m_k, k + 1)
        Those of dimension k = 0 to d: sites in ascending order. Sites that were not used are in none.
    values : tuple of float64 (m_k,)
        Squared radii, 0 for sites.
    faces : tuple of int32 (m_k, k + 1)
        For dimension k from 1 on the rows in ``simplices[k - 1]`` of a simplex without its first, second, ...
        vertex; for dimension 0 an array without rows.

    Examples
    --------
    >>> import dt3d
    >>> alpha = dt3d.Delaunay([[0, 0], [4, 0], [0, 3]]).alpha_complex()
    >>> [(simplex, value) for simplex, value in alpha][3:]
    [((0, 2), 2.25), ((0, 1), 4.0), ((1, 2), 6.25), ((0, 1, 2), 6.25)]
    """

    simplices: tuple[np.ndarray, ...]
    values: tuple[np.ndarray, ...]
    faces: tuple[np.ndarray, ...]

    def __init__(self, tri: Delaunay) -> None:
        from .geometry.measures import scaled_sites  # it loads numba

        top, rows, facets = _facets(tri)
        # at about 1, since the values of triangles are made of fourth powers, which over- or underflow
        points, unit = scaled_sites(tri.points)
        radii = tri.circumradii if unit == 1.0 else tri.circumradii / unit
        simplices, values, faces = [top, facets], [radii**2], [rows]
        if tri.ndim == 3:
            values.append(_of_triangles(points, top, rows, facets, values[0]))
            ends = facets.astype(np.int64)
            keys = ends[:, [1, 0, 0]] << 32 | ends[:, [2, 2, 1]]
            edges, row_of = np.unique(keys, return_inverse=True)
            simplices.append(np.column_stack([edges >> 32, edges & 0xFFFFFFFF]))
            faces.append(row_of.reshape(-1, 3).astype(np.int32))
        values.append(_of_edges(points, simplices[-2], faces[-1], simplices[-1], values[-1]))
        used = np.zeros(len(tri.points), bool)
        used[tri.simplices] = True
        number = np.cumsum(used) - 1
        simplices.append(np.flatnonzero(used)[:, None])
        faces.append(number[simplices[-2][:, ::-1]].astype(np.int32))
        values.append(np.zeros(len(simplices[-1])))
        faces.append(np.empty((0, 1), np.int32))
        self.simplices = tuple(frozen(array.astype(np.int32)) for array in reversed(simplices))
        # by turns, since the square of the unit may over- or underflow where a value does not
        self.values = tuple(frozen(array * unit * unit) for array in reversed(values))
        self.faces = tuple(frozen(array) for array in reversed(faces))

    def __len__(self) -> int:
        """The number of simplices of all dimensions."""
        return sum(map(len, self.values))

    def order(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The order of a filtration: by value, then by dimension, so that faces come first.

        Returns
        -------
        dimensions : int8 (m,)
            Of each simplex.
        rows : int64 (m,)
            Its row in ``simplices[dimension]``.
        values : float64 (m,)
            In ascending order.

        Examples
        --------
        >>> import dt3d
        >>> alpha = dt3d.Delaunay([[0, 0], [4, 0], [0, 3]]).alpha_complex()
        >>> [array.tolist() for array in alpha.order()]
        [[0, 0, 0, 1, 1, 1, 2], [0, 1, 2, 1, 2, 0, 0], [0.0, 0.0, 0.0, 2.25, 4.0, 6.25, 6.25]]
        """
        sizes = [len(array) for array in self.values]
        dimensions = np.repeat(np.arange(len(sizes), dtype=np.int8), sizes)
        rows = np.concatenate([np.arange(size) for size in sizes])
        values = np.concatenate(self.values)
        order = np.lexsort([rows, dimensions, values])
        return dimensions[order], rows[order], values[order]

    def __iter__(self) -> Iterator[tuple[tuple[int, ...], float]]:
        """Simplices and values in the order of the filtration, as GUDHI's ``get_filtration`` gives them."""
        lists = [array.tolist() for array in self.simplices]
        for k, row, value in zip(*(array.tolist() for array in self.order()), strict=True):
            yield tuple(lists[k][row]), value

    def boundary_matrix(self) -> scipy.sparse.csc_array:
        """The boundary of each simplex as a column, in the order of the filtration: int8 (m, m), 1 per face.

        What programs reduce for persistent homology with coefficients modulo 2. Columns of sites are empty.

        Examples
        --------
        >>> import dt3d
        >>> alpha = dt3d.Delaunay([[0, 0], [4, 0], [0, 3]]).alpha_complex()
        >>> alpha.boundary_matrix().toarray().sum(axis=0).tolist()
        [0, 0, 0, 2, 2, 2, 3]
        """
        from scipy.sparse import csc_array

        dimensions, rows, _ = self.order()
        m = len(rows)
        place = [np.empty(len(array), np.int64) for array in self.values]
        for k in range(len(place)):
            chosen = np.flatnonzero(dimensions == k)
            place[k][rows[chosen]] = chosen
        counts = np.where(dimensions == 0, 0, dimensions.astype(np.int64) + 1)
        indptr = np.concatenate([[0], np.cumsum(counts)])
        indices = np.empty(indptr[-1], np.int64)
        for k in range(1, len(place)):
            columns = np.sort(place[k - 1][self.faces[k]], axis=1)
            indices[indptr[place[k]][:, None] + np.arange(k + 1)] = columns
        return csc_array((np.ones(len(indices), np.int8), indices, indptr), shape=(m, m))

    def to_gudhi(self) -> Any:
        """A ``gudhi.SimplexTree`` with these simplices and values.

        Raises
        ------
        ImportError
            If GUDHI is not installed; it is with ``pip install gudhi``.

        Examples
        --------
        >>> import dt3d
        >>> alpha = dt3d.Delaunay([[0, 0], [4, 0], [0, 3]]).alpha_complex()
        >>> tree = alpha.to_gudhi()
        >>> tree.num_simplices(), tree.filtration([0, 1])
        (7, 4.0)
        """
        try:
            from gudhi import SimplexTree
        except ImportError as error:
            msg = f"to_gudhi() needs GUDHI, which cannot be loaded ({error}); get it by: pip install gudhi"
            raise ImportError(msg) from error
        tree = SimplexTree()
        for simplices, values in zip(self.simplices, self.values, strict=True):
            tree.insert_batch(simplices.T.copy(), values)
        return tree

    def __repr__(self) -> str:
        """How many simplices of each dimension."""
        return f"<dt3d.AlphaComplex: {', '.join(str(len(array)) for array in self.values)} simplices>"


def _facets(tri: Delaunay) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Simplices with their vertices in ascending order, the facet opposite each, and the facets themselves.

    int (m, d + 1) twice, and int (f, d).
    """
    order = np.argsort(tri.simplices, axis=1)
    top = np.take_along_axis(tri.simplices, order, axis=1)
    beside = np.take_along_axis(tri.neighbors, order, axis=1)
    m, corners = top.shape
    first = (beside == OUTSIDE) | (np.arange(m)[:, None] < beside)
    rows = np.full((m, corners), -1, np.int32)
    rows[first] = np.arange(np.count_nonzero(first), dtype=np.int32)
    # what the neighbour before has numbered; a neighbour shares one facet with a simplex
    t, k = np.nonzero(~first)
    u = beside[t, k]
    rows[t, k] = rows[u, np.argmax(beside[u] == t[:, None], axis=1)]
    t, k = np.nonzero(first)
    others = np.array([[i for i in range(corners) if i != j] for j in range(corners)])
    return top, rows, top[t[:, None], others[k]]


def _least_of(rows: np.ndarray, values: np.ndarray, faces: int) -> np.ndarray:
    """The least value of the simplices that each face bounds, by the rows of their faces."""
    least = np.full(faces, np.inf)
    for column in rows.T:
        np.minimum.at(least, column, values)
    return least


def _appearing(own: np.ndarray, least: np.ndarray, beaten: np.ndarray) -> np.ndarray:
    """The values of faces: their own, unless a vertex of what they bound lies inside; never beyond these."""
    values: np.ndarray = np.where(beaten, least, np.minimum(own, least))
    return values


def _of_triangles(
    points: np.ndarray, top: np.ndarray, rows: np.ndarray, triangles: np.ndarray, values: np.ndarray
) -> np.ndarray:
    """The values of the facets of tetrahedra, float64 (f,)."""
    from .geometry.gabriel import triangles_of_tetrahedra  # it loads numba

    own, beaten = triangles_of_tetrahedra(points, top, rows, triangles)
    return _appearing(own, _least_of(rows, values, len(triangles)), beaten)


def _of_edges(
    points: np.ndarray, triangles: np.ndarray, rows: np.ndarray, edges: np.ndarray, values: np.ndarray
) -> np.ndarray:
    """The values of the edges of triangles, float64 (e,): a vertex is inside where its angle is obtuse."""
    from .geometry.gabriel import edges_of_triangles

    own, beaten = edges_of_triangles(points, triangles, rows, edges)
    return _appearing(own, _least_of(rows, values, len(edges)), beaten)

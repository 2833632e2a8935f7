"""A triangulation as an object of SciPy's class, without Qhull."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import scipy.spatial

    from ._scipy_members import SciPyMembers

# Attributes of a scipy.spatial.Delaunay, which its own functions read. Those that are None are made by it
# when they are first asked for; _qhull is None in SciPy's, too, once a triangulation is complete.
EMPTY = ("_qhull", "_vertex_neighbor_vertices")
# what SciPy would make with NaN for slivers, and with duplicates at another place
HIDDEN = {"_points": "points", "_transform": "transform", "_vertex_to_simplex": "vertex_to_simplex"}
COPIED = ("simplices", "neighbors", "equations", "coplanar", "good", "min_bound", "max_bound")
SHARED = ("ndim", "npoints", "nsimplex", "paraboloid_scale", "paraboloid_shift", "furthest_site")


def to_scipy(tri: SciPyMembers) -> scipy.spatial.Delaunay:
    """An object of `scipy.spatial.Delaunay` with copies of the arrays of a triangulation.

    Raises
    ------
    ImportError
        If the class of the SciPy that is installed has other fields.
    """
    import scipy.spatial

    kind = scipy.spatial.Delaunay
    made: scipy.spatial.Delaunay = kind.__new__(kind)
    fields: dict[str, object] = dict.fromkeys(EMPTY)
    fields |= {name: getattr(tri, name) for name in SHARED}
    fields |= {name: np.array(getattr(tri, name)) for name in COPIED}
    fields |= {name: np.array(getattr(tri, ours)) for name, ours in HIDDEN.items()}
    unknown = _fields(kind) ^ set(fields)
    if unknown:
        msg = (
            f"this version of dt3d does not know the fields of scipy.spatial.Delaunay in SciPy "
            f"{scipy.__version__}: {', '.join(sorted(unknown))}"
        )
        raise ImportError(msg)
    made.__dict__.update(fields)
    return made


def _fields(kind: type[scipy.spatial.Delaunay]) -> set[str]:
    """The names of the attributes that an object of SciPy's class has."""
    return set(vars(kind([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])))

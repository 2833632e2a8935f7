"""The simplex that contains a point: exactly, on the host; or by a walk that is compiled with the program."""

from __future__ import annotations

from typing import Literal

import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike

from .callback import call_host
from .geometry import check_leading, checked, for_each_set
from .host import locate
from .mesh import Mesh
from .walk import walk

Method = Literal["exact", "walk"]


def find_simplex(points: ArrayLike, mesh: Mesh, xi: ArrayLike, method: Method = "exact") -> jax.Array:
    """The simplex that contains each point, as `dt3d.Delaunay.find_simplex`; a constant to derivatives.

    Parameters
    ----------
    points : (..., n, d)
        Those of which the mesh is; others make no sense of it, and the answers may be wrong.
    mesh : Mesh
        Of those points.
    xi : (..., d)
        The points to be located, beginning with the leading dimensions of the points.
    method : "exact" or "walk"
        "exact": on the host, by its threads, in one callback for a batch; of the numbers as they are, float32
        widened. "walk": all queries in step in one compiled loop, on the device. It goes where floating point
        is sure that a point lies beyond a facet; so a point that is as near to a facet as rounding errors may
        be found in the simplex next to it, or just inside the hull. Slower on CPUs.

    Returns
    -------
    int32 (...)
        Rows of ``mesh.simplices``; -1 outside the hull, for points that are not finite, and where the status
        of the mesh is not 0.

    Raises
    ------
    ValueError
        If shapes or dtypes do not fit; when the program is traced.

    Examples
    --------
    >>> import jax.numpy as jnp, dt3d.jax
    >>> triangle = jnp.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])
    >>> mesh = dt3d.jax.delaunay(triangle)
    >>> dt3d.jax.find_simplex(triangle, mesh, jnp.array([[0.5, 1.0], [9.0, 9.0]])).tolist()
    [0, -1]
    """
    if method not in ("exact", "walk"):
        msg = f'method must be "exact" or "walk", got {method!r}'
        raise ValueError(msg)
    sites, sets = checked(points, mesh)
    queries = jnp.asarray(xi)
    check_leading("xi", queries, sites, sites.shape[-1])
    if not jnp.issubdtype(queries.dtype, jnp.floating):
        queries = queries.astype(sites.dtype)
    sites, queries, simplices, neighbors = jax.lax.stop_gradient(
        (sites, queries, mesh.simplices, mesh.neighbors)
    )
    flat = queries.reshape(*queries.shape[:sets], -1, queries.shape[-1])
    if method == "walk":
        found = for_each_set(walk, sets)(sites, simplices, neighbors, flat)
    else:
        (found,) = call_host(locate, [(flat.shape[:-1], np.int32)], sites, simplices, neighbors, flat)
    return found.reshape(queries.shape[:-1])

"""A triangulation as JAX has it: arrays whose shapes do not depend on what is in them."""

from __future__ import annotations

from dataclasses import dataclass

import jax


@jax.tree_util.register_dataclass
@dataclass(frozen=True)
class Mesh:
    """The simplices of each set, in arrays of a fixed length; a pytree.

    All shapes begin with the leading dimensions of the points, none for one set.

    Attributes
    ----------
    simplices : int32 (..., capacity, d + 1)
        Rows of the points, positively oriented, as `dt3d.Delaunay.simplices`; rows of -1 beyond the last.
    neighbors : int32 (..., capacity, d + 1)
        The simplex opposite each vertex; -1 beyond the hull, and beyond the last simplex.
    count : int32 (...)
        How many simplices there are. Where they do not fit the capacity, how many are needed.
    status : int32 (...)
        Bits of `dt3d.jax.Status`; 0 if all is well. A set with a bit has rows of -1 alone.

    Examples
    --------
    >>> import jax.numpy as jnp, dt3d.jax
    >>> mesh = dt3d.jax.delaunay(jnp.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]))
    >>> mesh.count.item(), mesh.simplices.shape, mesh.status.item()
    (1, (6, 3), 0)
    """

    simplices: jax.Array
    neighbors: jax.Array
    count: jax.Array
    status: jax.Array

    @property
    def valid(self) -> jax.Array:
        """Which rows are simplices and not padding, bool (..., capacity).

        Examples
        --------
        >>> import jax.numpy as jnp, dt3d.jax
        >>> mesh = dt3d.jax.delaunay(jnp.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [3.0, 3.0]]), capacity=3)
        >>> mesh.valid.tolist(), mesh.count.item(), mesh.simplices[2].tolist()
        ([True, True, False], 2, [-1, -1, -1])
        """
        return self.simplices[..., 0] >= 0

"""Delaunay triangulations within JAX programs: under jit, vmap, grad, scan and checkpoint.

Import it as ``import dt3d.jax``; ``from dt3d import jax`` would hide JAX itself.

>>> import jax, jax.numpy as jnp, dt3d.jax
>>> points = jax.random.uniform(jax.random.key(0), (100, 3))
>>> def spread(points):
...     mesh = dt3d.jax.delaunay(points)
...     return (dt3d.jax.volumes(points, mesh) ** 2).sum()
>>> jax.jit(jax.grad(spread))(points).shape
(100, 3)
"""

from .interpolation import barycentric, interpolate
from .location import find_simplex
from .measures import circumcenters, circumradii, volumes
from .mesh import Mesh
from .status import Status
from .triangulation import delaunay

__all__ = [
    "Mesh",
    "Status",
    "barycentric",
    "circumcenters",
    "circumradii",
    "delaunay",
    "find_simplex",
    "interpolate",
    "volumes",
]

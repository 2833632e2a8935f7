"""The triangulation of points that a compiled program has, by one call of the host for a whole batch."""

from __future__ import annotations

from typing import Literal

import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike

from .._input import MOST_SITES
from .callback import call_host
from .host import triangulate_or_raise, triangulate_with_status
from .mesh import Mesh

# simplices per site: uniform sets in space have 6.77, no set of the tests more than 8; in the plane there are
# at most 2 n - 5
PER_SITE = {2: 2, 3: 8}
SPARE = {2: 0, 3: 64}
MOST_NUMBERS = 2**31  # of an array, which 32 bits count


def delaunay(
    points: ArrayLike, capacity: int | None = None, on_error: Literal["raise", "status"] = "raise"
) -> Mesh:
    """The Delaunay triangulation of points in the plane or in space, as `dt3d.Delaunay` finds it.

    The host triangulates, in one call for all sets of a batch, the nested ones of `jax.vmap`
    included: one set on each of its threads, or all threads on a set where there are few and they are
    large. On a GPU or TPU the points are copied to the host and the program waits.

    To derivatives the triangulation is constant. It is as long as no site crosses the circumsphere of a
    simplex; where one does, simplices flip. What is summed over the cells of sites, Voronoi volumes for
    example, passes a flip without a jump, since the circumcentres meet there. Sums over simplices, and linear
    interpolants, jump, and no derivative tells.

    Parameters
    ----------
    points : float32 or float64 (..., n, d)
        The sites, d = 2 or 3. The triangulation is that of the numbers as they are: what comes in float32 is
        widened, which is exact. Unless JAX has ``jax_enable_x64`` it rounds float64 of NumPy's to float32
        before. Of equal sites the first is used, and the others are in no simplex.
    capacity : int, optional
        Rows for simplices, a number when the program is traced. By default 8 n + 64 in space: uniform sites
        have 6.8 n, surfaces and grids less, and only sets made for it, on two skew lines or a moment
        curve, up to n^2 / 2. In the plane 2 n, which is enough for all.
    on_error : "raise" or "status"
        Whether sets that overflow, are not finite or degenerate end the program with an error of JAX's, whose
        last line is the reason; or leave a bit in `Mesh.status` and rows of -1. JAX does not say what else a
        program does in which a callback raises, so one that trains asks for the status.

    Returns
    -------
    Mesh
        Simplices, neighbours, their count and the status.

    Raises
    ------
    ValueError
        If shape, dtype or options are not these; when the program is traced.

    Examples
    --------
    >>> import jax, jax.numpy as jnp, dt3d.jax
    >>> square = jnp.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    >>> mesh = jax.jit(dt3d.jax.delaunay)(square)
    >>> mesh.simplices.shape, mesh.count.item()
    ((8, 3), 2)
    >>> sets = jnp.stack([square, 0 * square])
    >>> mesh = jax.vmap(lambda points: dt3d.jax.delaunay(points, on_error="status"))(sets)
    >>> mesh.count.tolist(), [dt3d.jax.Status(bits) for bits in mesh.status.tolist()]
    ([2, 0], [<Status: 0>, <Status.DEGENERATE: 4>])
    """
    sites = jnp.asarray(points)
    _check_points(sites)
    *batch, n, d = sites.shape
    rows = PER_SITE[d] * n + SPARE[d] if capacity is None else _checked(capacity)
    if rows * (d + 1) >= MOST_NUMBERS:
        msg = f"capacity={rows} rows of {d + 1} are too many for 32 bits; triangulate fewer sites at a time"
        raise ValueError(msg)
    if on_error not in ("raise", "status"):
        msg = f'on_error must be "raise" or "status", got {on_error!r}'
        raise ValueError(msg)
    simplices, number = ((*batch, rows, d + 1), np.int32), (tuple(batch), np.int32)
    shapes = [simplices, simplices, number, number]
    fill = triangulate_or_raise if on_error == "raise" else triangulate_with_status
    return Mesh(*call_host(fill, shapes, sites))


def _check_points(points: jax.Array) -> None:
    shape = points.shape
    if len(shape) < 2 or shape[-1] not in (2, 3):
        cure = "; it looks transposed: pass points.T" if len(shape) == 2 and shape[0] in (2, 3) else ""
        msg = f"points must have shape (..., n, 2) or (..., n, 3), got {shape}{cure}"
        raise ValueError(msg)
    if points.dtype not in (jnp.float32, jnp.float64):
        msg = f"points must be float32 or float64, got {points.dtype}; pass points.astype(jnp.float32)"
        raise ValueError(msg)
    n, least = shape[-2], shape[-1] + 1
    if n < least:
        msg = f"a triangulation of points (..., n, {least - 1}) needs n >= {least}, got shape {shape}"
        raise ValueError(msg)
    if n > MOST_SITES:
        msg = f"at most 2^25 = {MOST_SITES} sites can be numbered, got {n}"
        raise ValueError(msg)


def _checked(capacity: object) -> int:
    if isinstance(capacity, bool) or not isinstance(capacity, int | np.integer) or capacity < 1:
        what = "a traced value" if isinstance(capacity, jax.core.Tracer) else repr(capacity)
        msg = f"capacity must be a positive integer that is known when the program is traced, got {what}"
        raise ValueError(msg)
    return int(capacity)

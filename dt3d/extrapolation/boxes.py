"""Boxes: sets of cells that form a parallelepiped, held as ranges of cell coordinates.

Teng et al. 1993, section 4.2: the dead box of a search holds the cells already opened, the new box those that
will have been opened after the next round; the difference of the two is what the round opens.
"""

from __future__ import annotations

from typing import Any, Generic, NamedTuple, TypeAlias

import jax.numpy as jnp
from jax import Array

from .points import Point, T


class Grid(NamedTuple, Generic[T]):
    """The uniform cells: cell (i, j, k) is [origin + (i, j, k) side, origin + (i+1, j+1, k+1) side]."""

    origin: Point[T]  # the lowest corner of the sites' box
    high: Point[T]  # its highest corner
    side: T
    margin: T  # more than what rounding can have put a site, or a corner, to the wrong side
    nx: T
    ny: T
    nz: T


HostGrid: TypeAlias = Grid[Any]  # of NumPy scalars, floats of the working precision and int32


class Box(NamedTuple, Generic[T]):
    """Cells x0..x1, y0..y1, z0..z1, both ends included; empty when x1 < x0."""

    x0: T
    x1: T
    y0: T
    y1: T
    z0: T
    z1: T


def cell_index(coordinate: Array, origin: Array, side: Array, n: Array) -> Array:
    """Which of n cells of a side along an axis holds a coordinate; the nearest for those beyond."""
    # clipped as a float: where a sphere is huge the integer would overflow
    index = jnp.clip((coordinate - origin) / side, 0, n - 1)
    return jnp.where(jnp.isnan(index), 0, index).astype(jnp.int32)


def cell_coordinates(p: Point[Array], grid: Grid[Array]) -> tuple[Array, Array, Array]:
    """i, j, k of the cell that holds a point."""
    i = cell_index(p.x, grid.origin.x, grid.side, grid.nx)
    j = cell_index(p.y, grid.origin.y, grid.side, grid.ny)
    k = cell_index(p.z, grid.origin.z, grid.side, grid.nz)
    return i, j, k


def cell_of(p: Point[Array], grid: Grid[Array]) -> Array:
    """The number of the cell that holds a point, x running fastest."""
    i, j, k = cell_coordinates(p, grid)
    return i + grid.nx * (j + grid.ny * k)


def containment_box(low: Point[Array], high: Point[Array], grid: Grid[Array]) -> Box[Array]:
    """The least box of cells that contains the points from ``low`` to ``high``, within the grid."""
    return Box(
        cell_index(low.x, grid.origin.x, grid.side, grid.nx),
        cell_index(high.x, grid.origin.x, grid.side, grid.nx),
        cell_index(low.y, grid.origin.y, grid.side, grid.ny),
        cell_index(high.y, grid.origin.y, grid.side, grid.ny),
        cell_index(low.z, grid.origin.z, grid.side, grid.nz),
        cell_index(high.z, grid.origin.z, grid.side, grid.nz),
    )


def corners(i: Array, j: Array, k: Array, grid: Grid[Array]) -> tuple[Point[Array], Point[Array]]:
    """Lowest and highest corner of a cell, widened by the grid's margin, within the box of the sites.

    No site lies beyond that box, so a face of the hull that lies in one of its sides has no cell above it.
    """
    low, high = [], []
    for number, origin, end in zip((i, j, k), grid.origin, grid.high, strict=True):
        start = origin + number * grid.side - grid.margin
        low.append(jnp.maximum(start, origin))
        high.append(jnp.minimum(start + (grid.side + 2 * grid.margin), end))
    return Point(*low), Point(*high)


def empty_box(like: Array) -> Box[Array]:
    """A box without cells, of numbers like the given one."""
    zero = jnp.zeros_like(like)
    return Box(zero, zero - 1, zero, zero - 1, zero, zero - 1)


def volume(box: Box[Array]) -> Array:
    """How many cells a box has."""
    sides = (box.x1 - box.x0 + 1) * (box.y1 - box.y0 + 1) * (box.z1 - box.z0 + 1)
    return jnp.where(box.x1 < box.x0, 0, sides)


def contains(outer: Box[Array], inner: Box[Array]) -> Array:
    """Whether every cell of ``inner`` is one of ``outer``."""
    within = (
        (outer.x0 <= inner.x0) & (inner.x1 <= outer.x1)
        & (outer.y0 <= inner.y0) & (inner.y1 <= outer.y1)
        & (outer.z0 <= inner.z0) & (inner.z1 <= outer.z1)
    )  # fmt: skip
    return within | (inner.x1 < inner.x0)


def intersection(a: Box[Array], b: Box[Array]) -> Box[Array]:
    """The cells of both."""
    return Box(
        jnp.maximum(a.x0, b.x0), jnp.minimum(a.x1, b.x1),
        jnp.maximum(a.y0, b.y0), jnp.minimum(a.y1, b.y1),
        jnp.maximum(a.z0, b.z0), jnp.minimum(a.z1, b.z1),
    )  # fmt: skip


def missing(dead: Box[Array], target: Box[Array]) -> Array:
    """How many cells the box of both has beyond ``dead``."""
    both = Box(
        jnp.minimum(dead.x0, target.x0), jnp.maximum(dead.x1, target.x1),
        jnp.minimum(dead.y0, target.y0), jnp.maximum(dead.y1, target.y1),
        jnp.minimum(dead.z0, target.z0), jnp.maximum(dead.z1, target.z1),
    )  # fmt: skip
    return volume(both) - volume(dead)


def extend(dead: Box[Array], target: Box[Array], steps: Array) -> Box[Array]:
    """``dead`` grown towards ``target`` by at most ``steps`` cells in each of the six directions."""

    def low(d: Array, t: Array) -> Array:
        return jnp.maximum(jnp.minimum(d, t), d - steps)

    def high(d: Array, t: Array) -> Array:
        return jnp.minimum(jnp.maximum(d, t), d + steps)

    return Box(
        low(dead.x0, target.x0), high(dead.x1, target.x1),
        low(dead.y0, target.y0), high(dead.y1, target.y1),
        low(dead.z0, target.z0), high(dead.z1, target.z1),
    )  # fmt: skip


def difference_cell(new: Box[Array], dead: Box[Array], k: Array) -> tuple[Array, Array, Array]:
    """Coordinates of the k-th cell of ``new`` that is not in ``dead``; dead is within new, or empty.

    The difference is six slabs: below and above dead in z, then in y, then in x. k is counted through them.
    """
    # an empty dead box counts as lying just above the new one
    is_empty = dead.x1 < dead.x0
    z0 = jnp.where(is_empty, new.z1 + 1, dead.z0)
    z1 = jnp.where(is_empty, new.z1, dead.z1)
    slabs = [
        Box(new.x0, new.x1, new.y0, new.y1, new.z0, z0 - 1),
        Box(new.x0, new.x1, new.y0, new.y1, z1 + 1, new.z1),
        Box(new.x0, new.x1, new.y0, dead.y0 - 1, z0, z1),
        Box(new.x0, new.x1, dead.y1 + 1, new.y1, z0, z1),
        Box(new.x0, dead.x0 - 1, dead.y0, dead.y1, z0, z1),
        Box(dead.x1 + 1, new.x1, dead.y0, dead.y1, z0, z1),
    ]
    chosen, rest = slabs[0], k
    for slab in slabs[1:]:
        skipped = (chosen.x1 - chosen.x0 + 1) * (chosen.y1 - chosen.y0 + 1) * (chosen.z1 - chosen.z0 + 1)
        beyond = rest >= skipped
        rest = jnp.where(beyond, rest - skipped, rest)
        chosen = Box(*(jnp.where(beyond, s, c) for s, c in zip(slab, chosen, strict=True)))
    width = jnp.maximum(chosen.x1 - chosen.x0 + 1, 1)
    depth = jnp.maximum(chosen.y1 - chosen.y0 + 1, 1)
    row = rest // width
    return chosen.x0 + rest % width, chosen.y0 + row % depth, chosen.z0 + row // depth

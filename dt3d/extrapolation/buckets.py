"""Buckets: the sites, reordered so that sites near each other are neighbours in the list.

Teng et al. 1993, section 4.2, has uniform cells of about eight sites. They serve sites that fill space
evenly; for clusters, surfaces and the like the same order carries a tree of boxes (`tree/boxes.py`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array

import scanvec as sv

from .boxes import Grid, HostGrid, cell_coordinates, cell_of
from .points import Point
from .search_options import DEFAULT_SEARCH, SearchOptions
from .tree.boxes import Tree, build

# Sites are even if the cells that have any hold at most so many times that on average.
EVENNESS = 2.0
BITS_PER_WORD = 21  # of a coordinate in a Morton code, three of which fill a word
MOST_OF_A_CODE = 64  # sites with equal codes, before another word of finer codes tells them apart


class Cells(NamedTuple):
    """The uniform cells, and where each one's sites are in the list; x runs fastest."""

    grid: HostGrid
    starts: sv.Vector  # int32 (cells,)
    counts: sv.Vector  # int32 (cells,)


@dataclass(frozen=True)
class Buckets:
    """Sites along a Morton curve, and how to find those in a region.

    Attributes
    ----------
    sites : Point
        Three vectors of length n.
    origin : Vector of int32 (n,)
        The index of each site in the order it came.
    cells : Cells or None
        None where the sites are not even.
    options : SearchOptions
        How the cells are searched.
    """

    sites: Point[sv.Vector]
    origin: sv.Vector
    cells: Cells | None
    options: SearchOptions = DEFAULT_SEARCH

    @property
    def machine(self) -> sv.Machine:
        """Where the sites are."""
        return self.origin.machine

    @cached_property
    def tree(self) -> Tree:
        """Boxes over the sites, for those that are not even."""
        return build(self.sites)


def bucket(sites: Point[sv.Vector], options: SearchOptions = DEFAULT_SEARCH) -> Buckets:
    """Order sites along a Morton curve: of the cells that hold them, where these are evenly filled."""
    machine, n = sites.x.machine, len(sites.x)
    low = [float(sv.reduce(v, sv.MIN)) for v in sites]
    high = [float(sv.reduce(v, sv.MAX)) for v in sites]
    per_cell = options.sites_per_cell
    if options.uniform_cells:
        grid = cube_of_cells(low, high, n / per_cell, sites.x.dtype)
    else:
        grid = cubic_grid(low, high, n / per_cell, sites.x.dtype)
    cell = machine.map(cell_of, sites, grid)
    counts = machine.full(int(grid.nx) * int(grid.ny) * int(grid.nz), 0, np.int32)
    counts = sv.send(machine.full(n, 1, np.int32), cell, sv.ADD, into=counts)
    occupied = int(sv.reduce(counts > 0, sv.ADD))
    if not options.uniform_cells and n > EVENNESS * per_cell * occupied:
        return Buckets(*_along_curve(sites, low, high), None, options)
    code = machine.map(_code_of_cell, sites, grid)
    _, (ordered, origin, cell) = sv.sort(code, (sites, machine.iota(n), cell))
    starts = machine.full(len(counts), n, np.int32)
    starts = sv.send(machine.iota(n), cell, sv.MIN, into=starts)
    return Buckets(ordered, origin, Cells(grid, starts, counts), options)


def _along_curve(
    sites: Point[sv.Vector], low: list[float], high: list[float]
) -> tuple[Point[sv.Vector], sv.Vector]:
    """Sites and their origins in the order of fine Morton codes, of as many words as tell them apart."""
    machine, n = sites.x.machine, len(sites.x)
    extent = max(np.subtract(high, low))
    rest = Point(*(machine.map(_fraction, v, start, extent) for v, start in zip(sites, low, strict=True)))
    origin, words = machine.iota(n), []
    while True:
        word, rest = machine.map(_next_word, rest)
        words.append(word)
        _, order = sv.sort(tuple(words), origin)
        ordered = sv.get(tuple(words), order)
        if len(words) == 4 or _longest_run(ordered) <= MOST_OF_A_CODE:
            return sv.get(sites, order), order


def _longest_run(words: tuple[sv.Vector, ...]) -> int:
    """The most consecutive equal rows."""
    machine, n = words[0].machine, len(words[0])
    index = machine.iota(n)
    before = sv.get(words, index - 1, where=index > 0, otherwise=0)
    heads = machine.map(_differ, words, before) | (index == 0)
    return int(sv.reduce(sv.Segments.from_flags(heads).lengths, sv.MAX))


def _differ(words: tuple[Array, ...], others: tuple[Array, ...]) -> Array:
    return jnp.any(jnp.stack([a != b for a, b in zip(words, others, strict=True)]))


def _fraction(x: Array, low: Array, extent: Array) -> Array:
    return jnp.clip((x - low) / extent, 0, 1 - 2.0**-20)


def _next_word(rest: Point[Array]) -> tuple[Array, Point[Array]]:
    """The Morton code of the leading bits of three numbers in [0, 1), and what these leave."""
    scaled = [v * 2.0**BITS_PER_WORD for v in rest]
    whole = [jnp.floor(v) for v in scaled]
    left = Point(*(v - w for v, w in zip(scaled, whole, strict=True)))
    return morton_code(*(w.astype(jnp.int64) for w in whole)), left


def _code_of_cell(site: Point[Array], grid: Grid[Array]) -> Array:
    return morton_code(*(c.astype(jnp.int64) for c in cell_coordinates(site, grid)))


def morton_code(i: Array, j: Array, k: Array) -> Array:
    """Bits of three int64 below 2^21 in turn, those of i lowest."""
    code = jnp.zeros_like(i)
    for shift, x in enumerate((i, j, k)):
        for step, mask in (
            (32, 0x1F00000000FFFF), (16, 0x1F0000FF0000FF), (8, 0x100F00F00F00F00F),
            (4, 0x10C30C30C30C30C3), (2, 0x1249249249249249),
        ):  # fmt: skip
            x = (x | x << step) & mask
        code |= x << shift
    return code


def cubic_grid(low: list[float], high: list[float], wanted: float, dtype: npt.DTypeLike) -> HostGrid:
    """Cubic cells over the box from low to high, about ``wanted`` of them."""
    extents = np.maximum(np.subtract(high, low), 0)
    # bisect for the side: the number of cells falls with it, in steps
    small, large = extents.max() / 2**20, max(extents.max(), np.finfo(np.float32).tiny)
    for _ in range(60):
        side = np.sqrt(small * large)
        if np.prod(_divisions(extents, side)) > wanted:
            small = side
        else:
            large = side
    # of the numbers on both sides of the step the one that is nearer, divided evenly
    fine, coarse = _divisions(extents, small), _divisions(extents, large)
    counts = fine if np.prod(fine) * np.prod(coarse) < wanted**2 else coarse
    side = max((extents / counts).max(), np.finfo(np.float32).tiny)
    return _grid(low, high, side, counts, dtype)


def cube_of_cells(low: list[float], high: list[float], wanted: float, dtype: npt.DTypeLike) -> HostGrid:
    """The least cube over the box from low to high, divided alike along all axes: the paper's unit cube.

    As many cells along an axis as come nearest to the third root of ``wanted``.
    """
    extent = max(float(np.max(np.subtract(high, low))), float(np.finfo(np.float32).tiny))
    along = max(round(wanted ** (1 / 3)), 1)
    return _grid(low, [v + extent for v in low], extent / along, np.full(3, along), dtype)


def _grid(
    low: list[float], high: list[float], side: float, counts: np.ndarray, dtype: npt.DTypeLike
) -> HostGrid:
    number = np.float32 if np.dtype(dtype) == np.float32 else np.float64
    relative = 1e-3 if number is np.float32 else 1e-6
    greatest = float(np.abs([low, high]).max())
    margin = relative * side + 4 * float(np.finfo(number).eps) * greatest
    origin, end = (Point(*(number(v) for v in corner)) for corner in (low, high))
    return Grid(origin, end, number(side), number(margin), *counts.astype(np.int32))


def _divisions(extents: np.ndarray, side: float) -> np.ndarray:
    """How many cells of a side cover each extent."""
    return np.maximum(np.ceil(extents / side), 1)

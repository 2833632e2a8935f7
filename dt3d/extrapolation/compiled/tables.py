"""What a run looks up and never changes: sites in the order of fine cells, windows, rows of cells, digits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from ...predicates.traced.digits import limbs_of
from ..boxes import Grid
from ..exact.sites import are_small_integers
from ..points import Point
from .windows import AHEAD, SITES_PER_FINE_CELL, Windows, are_even, cells_of, grid_of, windows_of

FEWEST_SITES = 2000  # for fewer, compiling these steps takes longer than all else
SMALLEST_CAPACITY = 8192  # sites that arrays are made for, at least


class Layout(NamedTuple):
    """How many sites arrays are made for, and how many faces are together in a step and the loops in it."""

    capacity: int
    wave: int
    chunk: int
    cap_chunk: int


# Faces of a wave, a chunk, and a chunk of the cap search. On a CPU the data of a chunk fit into a core's
# cache.
FACES_ON = {"cpu": (2**13, 2048, 1024)}
FACES_ELSEWHERE = (2**17, 2**17, 2**15)


class Rows(NamedTuple):
    """The cells; the sites are in the order of these, so that those of a row follow each other."""

    grid: Grid[Array]
    starts: Array  # int32 (cells + 1, or more)


class Tables(NamedTuple):
    """What the compiled steps look up."""

    points: Point[Array]  # float64 (capacity,)
    windows: Windows
    rows: Rows
    lattice: bool  # whether heights are exact in floating point
    ahead: float  # `AHEAD` cells


class Digits(NamedTuple):
    """What exact decisions look up."""

    coordinates: tuple[tuple[Array, ...], ...]  # of each of three coordinates the digits, int32 (capacity,)
    rank: Array  # int32 (capacity,): each site's place in the lexicographic order


@dataclass(frozen=True)
class CellSites:
    """Sites (n, 3) in the order of fine cells, and the tables over them.

    Attributes
    ----------
    order : ndarray of int (n,)
        The place of each site in the lexicographic order, in which they came.
    sites : ndarray of float64 (n, 3)
        In the order of the cells.
    windows : Windows
        In NumPy.
    layout : Layout
        The sizes of arrays.
    tables : Tables
        In JAX.
    """

    order: np.ndarray
    sites: np.ndarray
    windows: Windows
    layout: Layout
    tables: Tables

    @cached_property
    def digits(self) -> Digits:
        """Coordinates as integers, for ties."""
        limbs = limbs_of(self.sites)
        n, capacity = len(self.sites), self.layout.capacity
        padded = np.zeros((3, len(limbs), capacity), np.int32)
        padded[:, :, :n] = limbs.transpose(2, 0, 1)
        rank = np.zeros(capacity, np.int32)
        rank[:n] = self.order
        return Digits(tuple(tuple(jnp.asarray(x) for x in axis) for axis in padded), jnp.asarray(rank))


def serves(sites: np.ndarray) -> bool:
    """Whether distinct sites (n, 3) are many, and fill space evenly."""
    return len(sites) >= FEWEST_SITES and are_even(sites)


def in_cells(given: np.ndarray) -> CellSites:
    """Distinct sites (n, 3) in lexicographic order, put into cells."""
    n = len(given)
    capacity = max(SMALLEST_CAPACITY, 1 << (n - 1).bit_length())
    grid = grid_of(given, SITES_PER_FINE_CELL)
    cell = cells_of(given, grid)
    order = np.argsort(cell, kind="stable")
    sites = given[order]
    windows = windows_of(sites, grid, capacity)
    cells = int(grid.nx) * int(grid.ny) * int(grid.nz)
    starts = np.full(max(2 * capacity, cells) + 1, n, np.int32)
    starts[: cells + 1] = np.searchsorted(cell[order], np.arange(cells + 1))
    padded = np.zeros((3, capacity))
    padded[:, :n] = sites.T
    faces = FACES_ON.get(jax.default_backend(), FACES_ELSEWHERE)
    points, windows_there, rows = jax.tree.map(jnp.asarray, (Point(*padded), windows, (grid, starts)))
    lattice, ahead = are_small_integers(limbs_of(given)), AHEAD * float(grid.side)
    tables = Tables(points, windows_there, Rows(*rows), lattice, ahead)
    return CellSites(order, sites, windows, Layout(capacity, *(min(x, capacity) for x in faces)), tables)

"""Positions along Hilbert's curve: near in number means near in space, without the jumps of the Morton order.

The halves, quarters and eighths of the curve are pieces of space of their own, and so is what remains of it
without one of them: the pieces of the curve that threads own can be moved along it, and what was the boundary
of two pieces becomes the inside of one.

In each cell of a level the curve is turned: coordinates are exchanged and complemented. A table has, for a
turn and some bits of each coordinate, the place in the cell and the turn there. In the plane one look-up
takes four bits, in space three.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import NamedTuple, TypeVar

import numpy as np

from .._numba.kernel_cache import cached_njit

S = TypeVar("S", bound=Hashable)

TURN_BITS = 6  # of an entry of the tables: the number of the turn
PLANE_BITS, PLANE_STEP = 24, 4  # of a coordinate, at most, and of one look-up
SPACE_BITS, SPACE_STEP = 21, 3


SpaceTurn = tuple[tuple[int, ...], tuple[int, ...], int]


class Grid(NamedTuple):
    """The cells of a curve, 2^bits a side, and where numbers of sites go in its keys.

    A coordinate x is in cell (x part - low) first scale. ``part`` is a power of two with which no difference
    overflows, ``first`` one with which a tiny difference becomes a normal number. All this rounds, but
    depends on the coordinates of the site alone: equal sites are in one cell.
    """

    low: tuple[float, ...]  # the least corner, times part
    part: float
    first: float
    scale: float
    bits: int
    index_bits: int


def _plane_step(turn: tuple[int, int], cell: tuple[int, ...]) -> tuple[int, tuple[int, int]]:
    """Return the quarter, 0 to 3, in which a cell comes, and how the curve is turned there."""
    exchanged, complemented = turn
    x, y = (bit ^ complemented for bit in (reversed(cell) if exchanged else cell))
    if y == 0:
        return 3 * x, (1 - exchanged, complemented ^ x)
    return (3 * x) ^ 1, turn


def _space_step(turn: SpaceTurn, cell: tuple[int, ...]) -> tuple[int, SpaceTurn]:
    """Return the eighth, 0 to 7, in which a cell comes, and how the curve is turned there.

    J. Skilling: Programming the Hilbert curve. AIP Conference Proceedings 707, 2004. A turn is the axis and
    the complement of each coordinate, and the parity of his Gray code.
    """
    axes, complements, parity = list(turn[0]), list(turn[1]), turn[2]
    x, y, z = (cell[axis] ^ complement for axis, complement in zip(*turn[:2], strict=True))
    for k, bit in enumerate((x, y, z)):
        if bit:
            complements[0] ^= 1
        else:
            axes[0], axes[k] = axes[k], axes[0]
            complements[0], complements[k] = complements[k], complements[0]
    y ^= x
    z ^= y
    eighth = (x ^ parity) << 2 | (y ^ parity) << 1 | (z ^ parity)
    return eighth, (tuple(axes), tuple(complements), parity ^ z)


def _table(
    step: Callable[[S, tuple[int, ...]], tuple[int, S]], first: S, dimension: int, bits: int
) -> np.ndarray:
    """Return the table of ``bits`` steps, uint16, for all turns that follow from the first one.

    Entry (turn, x, y, ...), with ``bits`` bits of each coordinate, is the place times 2^TURN_BITS plus the
    turn there.
    """
    turns = [first]
    places: list[list[int]] = []
    nexts: list[list[int]] = []
    for turn in turns:  # grows
        made = [step(turn, cell) for cell in np.ndindex(*[2] * dimension)]
        turns += [t for t in dict.fromkeys(t for _, t in made) if t not in turns]
        places.append([place for place, _ in made])
        nexts.append([turns.index(t) for _, t in made])
    place_of, next_of = np.array(places), np.array(nexts)
    number, *cell = np.indices((len(turns), *[1 << bits] * dimension)).reshape(dimension + 1, -1)
    place = np.zeros_like(number)
    for i in reversed(range(bits)):
        corner = np.zeros_like(number)
        for c in cell:
            corner = corner << 1 | c >> i & 1
        place = place << dimension | place_of[number, corner]
        number = next_of[number, corner]
    entries: np.ndarray = (place << TURN_BITS | number).astype(np.uint16)
    return entries


_PLANE = _table(_plane_step, (0, 0), 2, PLANE_STEP)
_FIRST: SpaceTurn = (0, 1, 2), (0, 0, 0), 0
_SPACE = _table(_space_step, _FIRST, 3, SPACE_STEP)


@cached_njit(nogil=True, forceinline=True)
def place_in_plane(x, y):
    """Return the place of cell (x, y), of 2^PLANE_BITS cells a side, along the curve: uint64."""
    place, turn = np.uint64(0), np.int64(0)
    for shift in range(PLANE_BITS - PLANE_STEP, -1, -PLANE_STEP):
        entry = _PLANE[turn << 8 | (x >> shift & 15) << 4 | y >> shift & 15]
        place = place << np.uint64(8) | np.uint64(entry >> TURN_BITS)
        turn = np.int64(entry & (1 << TURN_BITS) - 1)
    return place


@cached_njit(nogil=True, forceinline=True)
def place_in_space(x, y, z):
    """Return the place of cell (x, y, z), of 2^SPACE_BITS cells a side, along the curve: uint64."""
    place, turn = np.uint64(0), np.int64(0)
    for shift in range(SPACE_BITS - SPACE_STEP, -1, -SPACE_STEP):
        entry = _SPACE[turn << 9 | (x >> shift & 7) << 6 | (y >> shift & 7) << 3 | z >> shift & 7]
        place = place << np.uint64(9) | np.uint64(entry >> TURN_BITS)
        turn = np.int64(entry & (1 << TURN_BITS) - 1)
    return place


@cached_njit(inline="always")
def _cell(sites, grid, i, k):
    """Return the k-th coordinate of the cell of a site."""
    place = np.int64((sites[i, k] * grid.part - grid.low[k]) * grid.first * grid.scale)
    return min(place, (1 << grid.bits) - 1)


@cached_njit(nogil=True, error_model="numpy")
def keys_in_plane(sites, grid, out, begin):
    """Write the place along the curve of each site, with its number in the low bits: uint64.

    ``out`` has room for the sites from ``begin`` on whose keys are written.
    """
    finer = PLANE_BITS - grid.bits
    for i in range(begin, begin + len(out)):
        x, y = _cell(sites, grid, i, 0), _cell(sites, grid, i, 1)
        place = place_in_plane(x << finer, y << finer) >> np.uint64(2 * finer)
        out[i - begin] = place << np.uint64(grid.index_bits) | np.uint64(i)


@cached_njit(nogil=True, error_model="numpy")
def keys_in_space(sites, grid, out, begin):
    """Write the same in space."""
    finer = SPACE_BITS - grid.bits
    for i in range(begin, begin + len(out)):
        x, y, z = _cell(sites, grid, i, 0), _cell(sites, grid, i, 1), _cell(sites, grid, i, 2)
        place = place_in_space(x << finer, y << finer, z << finer) >> np.uint64(3 * finer)
        out[i - begin] = place << np.uint64(grid.index_bits) | np.uint64(i)

"""What the host does for a compiled program, in threads of its own: it triangulates and locates.

Nothing here may call JAX, which waits for this to end; with all of its threads waiting it never would. So
this module does not import it, and its arguments are arrays of NumPy (`callback.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import numpy.typing as npt

from .._errors import DegenerateInputError
from .._input import exactly_scaled
from .._numba.announce import announce_compilation
from .._numba.cores import available_cores
from .._numba.threads import run_threads
from .._topology import OUTSIDE
from ..location import Locator
from .status import Status
from .whole_arithmetic import in_whole_arithmetic

Arrays = tuple[np.ndarray, ...]
# sites of a set from which all threads on one set after another beat one set per thread, where there are
# fewer sets than threads
SITES_WORTH_ALL_THREADS = 20_000


class _TooMany(Exception):
    """There are more simplices than rows."""

    def __init__(self, needed: int) -> None:
        self.needed = needed


class _Rows:
    """Room for the simplices and neighbours of one set, int32 (2, capacity, d + 1).

    That of a batch; or, where there is one set, what has served to triangulate it, if that is enough.
    """

    def __init__(self, capacity: int, d: int, of_batch: np.ndarray | None) -> None:
        self.shape = (2, capacity, d + 1)
        self.arrays = of_batch

    def room(self, needed: int, spare: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if needed > self.shape[1]:
            raise _TooMany(needed)
        if self.arrays is None:
            size = math.prod(self.shape)
            memory = spare[:size] if len(spare) >= size else np.empty(size, np.int32)
            self.arrays = memory.reshape(self.shape)
        return self.arrays[0, :needed], self.arrays[1, :needed]

    @property
    def finished(self) -> np.ndarray:
        assert self.arrays is not None
        return self.arrays

    def pad(self, used: int) -> None:
        if self.arrays is None:
            self.arrays = np.empty(self.shape, np.int32)
        self.arrays[:, used:] = OUTSIDE


@cache
def triangulator(capacity: int, raises: bool) -> Callable[[npt.ArrayLike], Arrays]:
    """The function of points (..., n, d) that triangulates; one object for one pair, as JAX's caches want.

    It returns simplices and neighbors, int32 (..., capacity, d + 1), counts and status, int32 (...). With
    ``raises`` a set that has no simplices is a ValueError.
    """

    def triangulate(points: npt.ArrayLike) -> Arrays:
        sets = np.asarray(points)
        *batch, n, d = sets.shape
        sets = sets.reshape(-1, n, d)
        both = np.empty((2, len(sets), capacity, d + 1), np.int32) if len(sets) != 1 else None
        rows = [_Rows(capacity, d, None if both is None else both[:, k]) for k in range(len(sets))]
        count, status = (np.zeros(len(sets), np.int32) for _ in range(2))

        def one(k: int, threads: int | None) -> None:
            count[k], status[k] = _into_rows(sets[k], rows[k], threads)
            if raises and status[k]:
                which = f"set {k} of {len(sets)}: " if batch else ""
                raise ValueError(which + _problem(sets[k], Status(int(status[k])), int(count[k]), capacity))

        in_whole_arithmetic(lambda: _for_each(len(sets), n < SITES_WORTH_ALL_THREADS, one))
        simplices, neighbors = rows[0].finished if both is None else both
        shape = (*batch, capacity, d + 1)
        return simplices.reshape(shape), neighbors.reshape(shape), count.reshape(batch), status.reshape(batch)

    return triangulate


def locate(
    points: npt.ArrayLike, simplices: npt.ArrayLike, neighbors: npt.ArrayLike, xi: npt.ArrayLike
) -> Arrays:
    """The simplex that contains each point, exactly: one array, int32 (..., q), -1 where there is none.

    Arrays are points (..., n, d), simplices and neighbors (..., capacity, d + 1), and xi (..., q, d). A
    leading dimension is 1 where the array is the same for all.
    """
    announce_compilation()
    given = [np.asarray(a) for a in (points, simplices, neighbors)]
    queries = np.asarray(xi)
    own = np.broadcast_shapes(*(a.shape[:-2] for a in given))
    batch = np.broadcast_shapes(own, queries.shape[:-2])
    queries = np.broadcast_to(queries, batch + queries.shape[-2:])
    out = np.empty(queries.shape[:-1], np.int32)
    sets = list(np.ndindex(own))

    def one(k: int, threads: int | None) -> None:
        sites, cells, across = (
            a[tuple(min(i, size - 1) for i, size in zip(sets[k], a.shape, strict=False))] for a in given
        )
        # all that ask this set
        asking = tuple(slice(None) if s == 1 else i for i, s in zip(sets[k], own, strict=True))
        out[asking] = _located(sites, cells, across, queries[asking])

    in_whole_arithmetic(lambda: _for_each(len(sets), queries.shape[-2] < SITES_WORTH_ALL_THREADS, one))
    return (out,)


def _located(sites: np.ndarray, cells: np.ndarray, across: np.ndarray, queries: np.ndarray) -> np.ndarray:
    m = int(np.count_nonzero(cells[:, 0] >= 0))
    if not m:
        return np.full(queries.shape[:-1], OUTSIDE, np.int32)
    return Locator(sites.astype(np.float64), cells[:m], across[:m]).find(queries.astype(np.float64))


def _into_rows(sites: np.ndarray, rows: _Rows, threads: int | None) -> tuple[int, Status]:
    """Write simplices and neighbours of sites (n, d), and -1 beyond; how many there are, and the status."""
    used = count = 0
    status = Status(0)
    points = sites.astype(np.float64)
    if np.isfinite(points).all():
        try:
            used = count = _triangulate(exactly_scaled(points), threads, rows)
        except _TooMany as overflow:
            count, status = overflow.needed, Status.OVERFLOW
        except DegenerateInputError:
            status = Status.DEGENERATE
    else:
        status = Status.NOT_FINITE
    rows.pad(used)
    return count, status


def _triangulate(points: np.ndarray, threads: int | None, rows: _Rows) -> int:
    """Triangulate scaled points, float64 (n, d), into these rows; how many simplices there are."""
    announce_compilation()
    if points.shape[1] == 3:
        from ..insertion import triangulate

        return len(triangulate(points, threads=threads, room=rows.room).simplices)
    from ..threaded2d.configuration import configured
    from ..threaded2d.driver import triangulate as triangulate_in_plane

    return len(triangulate_in_plane(points, configured(len(points), threads=threads), rows.room).triangles)


def _problem(sites: np.ndarray, status: Status, count: int, capacity: int) -> str:
    """What came, and what to do."""
    n, d = sites.shape
    if status is Status.OVERFLOW:
        kind = "tetrahedra" if d == 3 else "triangles"
        return f"{n} sites have {count} {kind}, more than capacity={capacity}; pass capacity={count} or more"
    softer = 'on_error="status" returns a bit instead'
    if status is Status.NOT_FINITE:
        bad = np.flatnonzero(~np.isfinite(sites).all(axis=1))
        return f"points must be finite: {len(bad)} rows have NaN or infinity, the first is {bad[0]}; {softer}"
    flat = "four sites that do not lie on a plane" if d == 3 else "three sites that do not lie on a line"
    return f"a triangulation needs {flat}, and these {n} have none such; {softer}"


def _for_each(count: int, small: bool, work: Callable[[int, int | None], object]) -> None:
    """Call ``work(k, threads)`` for each k: by threads with one k each, or by this one with all threads."""
    busy = min(available_cores(), count)
    if busy < 2 or not (small or count >= available_cores()):
        for k in range(count):
            work(k, None)
        return
    numbers = iter(range(count))
    stopped = False

    def some() -> None:
        for k in numbers:
            if stopped:
                break
            work(k, 1)

    def stop() -> None:
        nonlocal stopped
        stopped = True

    run_threads([some] * busy, stop)

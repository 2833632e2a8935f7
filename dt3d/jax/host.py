"""What the host does for a compiled program, in threads of its own: it triangulates and locates.

Nothing here may call JAX, which waits for this to end; with all of its threads waiting it never would. So
this module does not import it, and reads and fills arrays of NumPy (`callback.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .._errors import DegenerateInputError
from .._input import exactly_scaled
from .._numba.cores import available_cores
from .._numba.threads import run_threads
from .._topology import OUTSIDE
from ..location import Locator
from .status import Status
from .whole_arithmetic import in_whole_arithmetic

if TYPE_CHECKING:
    from ..threaded2d.compaction import Room

Arrays = Sequence[np.ndarray]
# sites of a set from which all threads on one set after another beat one set per thread, where there are
# fewer sets than threads
SITES_WORTH_ALL_THREADS = 20_000


class _TooMany(Exception):
    """There are more simplices than rows."""

    def __init__(self, needed: int) -> None:
        self.needed = needed


def triangulate_or_raise(given: Arrays, results: Arrays) -> None:
    """Triangulate sets of sites, and raise a ValueError for one that has no simplices."""
    _triangulate_all(given, results, raises=True)


def triangulate_with_status(given: Arrays, results: Arrays) -> None:
    """Triangulate sets of sites; the status says which of them have no simplices."""
    _triangulate_all(given, results, raises=False)


def _triangulate_all(given: Arrays, results: Arrays, raises: bool) -> None:
    """Fill simplices and neighbors, int32 (..., capacity, d + 1), counts and status, int32 (...).

    Given are points (..., n, d).
    """
    (points,) = given
    simplices, neighbors, count, status = results
    *batch, n, d = points.shape
    capacity = simplices.shape[-2]
    sets = points.reshape(-1, n, d)
    rows = [a.reshape(-1, capacity, d + 1) for a in (simplices, neighbors)]
    counts, bits = count.reshape(-1), status.reshape(-1)

    def one(k: int, threads: int | None) -> None:
        counts[k], bits[k] = _into_rows(sets[k], rows[0][k], rows[1][k], threads)
        if raises and bits[k]:
            which = f"set {k} of {len(sets)}: " if batch else ""
            raise ValueError(which + _problem(sets[k], Status(int(bits[k])), int(counts[k]), capacity))

    in_whole_arithmetic(lambda: _for_each(len(sets), n < SITES_WORTH_ALL_THREADS, one))


def locate(given: Arrays, results: Arrays) -> None:
    """The simplex that contains each point, exactly: int32 (..., q), -1 where there is none.

    Given are points (..., n, d), simplices and neighbors (..., capacity, d + 1), and xi (..., q, d). A
    leading dimension is 1 where the array is the same for all.
    """
    *triangulation, queries = given
    (out,) = results
    own = np.broadcast_shapes(*(a.shape[:-2] for a in triangulation))
    queries = np.broadcast_to(queries, out.shape + queries.shape[-1:])
    sets = list(np.ndindex(own))

    def one(k: int, threads: int | None) -> None:
        sites, cells, across = (
            a[tuple(min(i, size - 1) for i, size in zip(sets[k], a.shape, strict=False))]
            for a in triangulation
        )
        # all that ask this set
        asking = tuple(slice(None) if s == 1 else i for i, s in zip(sets[k], own, strict=True))
        out[asking] = _located(sites, cells, across, queries[asking])

    in_whole_arithmetic(lambda: _for_each(len(sets), queries.shape[-2] < SITES_WORTH_ALL_THREADS, one))


def _located(sites: np.ndarray, cells: np.ndarray, across: np.ndarray, queries: np.ndarray) -> np.ndarray:
    m = int(np.count_nonzero(cells[:, 0] >= 0))
    if not m:
        return np.full(queries.shape[:-1], OUTSIDE, np.int32)
    return Locator(sites.astype(np.float64), cells[:m], across[:m]).find(queries.astype(np.float64))


def _into_rows(
    sites: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray, threads: int | None
) -> tuple[int, Status]:
    """Write what sites (n, d) have, and -1 beyond; how many simplices there are, and the status."""
    used = count = 0
    status = Status(0)
    points = sites.astype(np.float64, copy=False)

    def room(needed: int) -> tuple[np.ndarray, np.ndarray]:
        if needed > len(simplices):
            raise _TooMany(needed)
        return simplices[:needed], neighbors[:needed]

    if np.isfinite(points).all():
        try:
            used = count = _triangulate(exactly_scaled(points), threads, room)
        except _TooMany as overflow:
            count, status = overflow.needed, Status.OVERFLOW
        except DegenerateInputError:
            status = Status.DEGENERATE
    else:
        status = Status.NOT_FINITE
    simplices[used:] = neighbors[used:] = OUTSIDE
    return count, status


def _triangulate(points: np.ndarray, threads: int | None, room: Room) -> int:
    """Triangulate scaled points, float64 (n, d), into that room; how many simplices there are."""
    if points.shape[1] == 3:
        from ..insertion import triangulate

        return len(triangulate(points, threads=threads, room=room).simplices)
    from ..threaded2d.configuration import configured
    from ..threaded2d.driver import triangulate as triangulate_in_plane

    return len(triangulate_in_plane(points, configured(len(points), threads=threads), room).triangles)


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
    """Call ``work(k, threads)`` for each k: by threads with one k each, or by this one with all threads.

    Raises what the first k raises that does, whichever thread comes to its own first.
    """
    busy = min(available_cores(), count)
    if busy < 2 or not (small or count >= available_cores()):
        for k in range(count):
            work(k, None)
        return
    numbers = iter(range(count))
    stopped = False
    failures: dict[int, Exception] = {}

    def some() -> None:
        for k in numbers:
            if stopped:
                break
            try:
                work(k, 1)
            except Exception as error:  # a thread with a lower number may be about to fail
                failures[k] = error
                stop()

    def stop() -> None:
        nonlocal stopped
        stopped = True

    run_threads([some] * busy, stop)
    if failures:
        raise failures[min(failures)]

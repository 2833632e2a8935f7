"""Work on rows, in parts of them by threads."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from .._numba.cores import available_cores
from .._numba.threads import run_short_tasks

LEAST_ROWS = 4096  # of a thread


def run_in_parts(
    work: Callable[[int, int, int], object],
    rows: int,
    threads: int | None,
    begins: np.ndarray | None = None,
) -> None:
    """Call ``work(k, begin, end)`` for the k-th of some ranges that make up all rows, each in a thread.

    Parameters
    ----------
    work : function
        It releases the interpreter's lock.
    rows : int
        How many there are.
    threads : int, optional
        The most threads; as many as cores if left out.
    begins : int (rows + 1,), optional
        How much there is to do before each row, if not as much for each.
    """
    most = available_cores() if threads is None else min(threads, available_cores())
    whole = rows if begins is None else int(begins[-1])
    parts = max(1, min(most, rows, whole // LEAST_ROWS))
    cuts = [whole * k // parts for k in range(parts + 1)]
    if begins is not None:
        cuts = [0, *np.searchsorted(begins, cuts[1:-1]).tolist(), rows]
    run_short_tasks([partial(work, k, cuts[k], cuts[k + 1]) for k in range(parts)])

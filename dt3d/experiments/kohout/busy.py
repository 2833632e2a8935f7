"""Whether other programs use the processors while times are measured."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

from ..._numba.cores import available_cores
from ..._numba.kernel_cache import cached_njit
from ..._numba.threads import run_threads

if TYPE_CHECKING:
    from rich.console import Console

ENOUGH = 0.9  # of the processors' time
STEPS = 50_000_000  # of a thread that only computes: some 0.1 s
TRIALS = 3  # a pause of the system in one of them says little


@cached_njit(nogil=True)
def _compute(steps):
    x = 1
    for _ in range(steps):
        x = (x * 6364136223846793005 + 1442695040888963407) & 0x7FFFFFFFFFFFFFFF
    return x


def _share(steps: int) -> float:
    """Processor time over wall time of a thread that only computes."""
    begun, used = time.perf_counter(), time.thread_time()
    _compute(steps)
    return (time.thread_time() - used) / (time.perf_counter() - begun)


def free_share(steps: int = STEPS) -> float:
    """The share of its time that a thread gets when each processor has one: about 1 if nothing else runs.

    The best of some trials, of each the thread that gets least.
    """
    _compute(1)
    threads = [partial(_share, steps) for _ in range(available_cores())]
    return max(min(run_threads(threads, lambda: None)) for _ in range(TRIALS))


def warn_if_busy(console: Console) -> None:
    """Print a line if other programs use the processors."""
    share = free_share()
    if share < ENOUGH:
        console.print(
            f"Warning: the machine is busy. A thread per processor gets {100 * share:.0f} % of the time, so "
            "measured speed-ups are too small, and differ from run to run.",
            soft_wrap=True,
        )

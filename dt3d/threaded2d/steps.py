"""What all methods' threads have in common: going in steps, accounting for time, stopping.

A step locates a site, changes the structure, or finds that it has to wait, and returns which. Real threads
loop over steps, and so does the scheduler of virtual time.
"""

from __future__ import annotations

from .._numba.atomics import cycles, load, nap
from .._numba.kernel_cache import cached_njit
from .dag import locate
from .in_place.walk import walk_history
from .mesh import HINT, SOFT_LIMIT, STOP, USED, WAIT_CYCLES, WAITS

LOOKS = 50  # at the queue before a thread that waits sleeps: about a microsecond

# what a step returns
LOCATED, CHANGED, WAITING, FINISHED = range(4)

# what a thread's run returns; no run returns `GO_ON`
DONE, STOPPED, FULL, OPEN_SWAPS, GO_ON = range(5)


@cached_njit
def now():
    """The cycle counter."""
    return cycles()


@cached_njit(forceinline=True)
def verdict(shared, may_stop, may_fill):
    """`STOPPED` when all threads have to stop, `FULL` when the structure has to grow first, or `GO_ON`.

    A thread that holds what others wait for says with ``may_stop`` and ``may_fill`` that it cannot return
    yet.
    """
    if may_stop and load(shared, (STOP, 0)) != 0:
        return STOPPED
    if may_fill and load(shared, (USED, 0)) > shared[SOFT_LIMIT, 0]:
        return FULL
    return GO_ON


@cached_njit(forceinline=True)
def find(points, nodes, state, me, q, walking, w):
    """The leaf that contains q, from the roots or by walking from the last one, and how many were visited."""
    if walking:
        return walk_history(points, nodes, state[me, HINT], q, w)
    return locate(points, nodes, q, w)


@cached_njit(forceinline=True)
def spend(state, me, column, begun):
    """Enter the cycles since ``begun`` into a column; now."""
    ended = cycles()
    state[me, column] += ended - begun
    return ended


@cached_njit(forceinline=True)
def pause(state, me, column, did, waiting, begun):
    """Account for a step of a thread at the queue, and wait a little where it has to: look again, then sleep.

    A nap does not empty a long queue, nor fill it. Giving way would be worse with more threads than
    processors: a scheduler may then let another one run for milliseconds.

    Returns how many steps in a row have waited, and when the present wait, or what is no wait, began.
    """
    if (did == WAITING) != (waiting > 0):
        begun = spend(state, me, WAIT_CYCLES if waiting else column, begun)
        state[me, WAITS] += did == WAITING
    if did != WAITING:
        return 0, begun
    if waiting > LOOKS:
        nap()
    return waiting + 1, begun

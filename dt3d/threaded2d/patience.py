"""No loop without an end: bounds that no right run reaches, and the patience of threads that wait.

A loop whose steps have a bound counts them, and raises `InternalError` beyond it; the bound is derived where
it stands. A wait for another thread has none, since the system may take the processor from that thread for
as long as it likes. What holds of waits instead:

* Every waiting thread looks at `columns.STOP` in each turn. An exception in one thread, and an interrupt, set
  it and so end all waits.
* No wait is mutual. Threads of the optimistic methods give back their locks before they wait; those of the
  circum-circle method enter no wait that would close a circle (`pool.wait_for`); the critical section and a
  cell of the queue are left after a few operations that wait for nothing; the searching threads wait for room
  in the queue, which the specialised one makes, and it for elements, which are in the queue or come.
* A thread that waits, or tries in vain, adds up its effort, and from time to time looks whether any thread
  has come on meanwhile. When none has after `columns.MOST_LOOKS` looks, something is broken: some minutes at
  least, whereas the longest insertion or location, of 2^25 sites, takes seconds. Effort and not time is
  counted, so that a process may be suspended.
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import TURNS, load, wait_a_little
from .._numba.kernel_cache import cached_njit
from . import columns as c

# effort, in units that take 8 ns or more
STEP = 4  # an attempt of any kind
GIVING_WAY = 16
NAP = 4096
BETWEEN_LOOKS = 1 << 24

LOOKS_AT_QUEUE = 50  # before a thread that waits there sleeps: about a microsecond


@cached_njit
def _look(shared, state, me):
    """Look whether a thread has come on since thread ``me`` looked last."""
    done = 0
    for i in range(len(state)):
        done += load(state, (i, c.INSERTED)) + load(state, (i, c.FLIPS)) + load(state, (i, c.NEXT))
    state[me, c.EFFORT] = 0
    if done != state[me, c.SEEN]:
        state[me, c.SEEN], state[me, c.LOOKED] = done, 0
        return
    state[me, c.LOOKED] += 1
    if state[me, c.LOOKED] > shared[c.MOST_LOOKS, 0]:
        msg = "threads of a 2D triangulation wait for each other, and none comes on"
        raise InternalError(msg)


@cached_njit(forceinline=True)
def strive(mesh, me, more):
    """Add to the effort of thread ``me`` since it looked last, and look where that is much.

    Raises
    ------
    InternalError
        If no thread has come on for `MOST_LOOKS` looks.
    """
    mesh.state[me, c.EFFORT] += more
    if mesh.state[me, c.EFFORT] >= BETWEEN_LOOKS:
        _look(mesh.shared, mesh.state, me)


@cached_njit(forceinline=True)
def wait_in_turns(mesh, me, waited):
    """Give way for some turns, then sleep in each."""
    mesh.state[me, c.WAITS] += waited == 0
    wait_a_little(waited)
    return GIVING_WAY if waited < TURNS else NAP

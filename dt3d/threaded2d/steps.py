"""What all methods have in common: they go in steps, and one loop runs the steps of a thread to their end.

A step locates a site, changes the structure, or finds that it has to wait, and returns which. Real threads
loop over steps, and so does the scheduler of virtual time.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from types import FunctionType
from typing import Any, NamedTuple, TypeVar, cast

from .._numba.atomics import cycles, load
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from . import columns as c
from .mesh import inject_yield
from .patience import STEP, strive, wait_in_turns

# what a step returns; `QUEUED`: sites went into the queue; `LOCKED`: the cavity is this thread's own
LOCATED, CHANGED, WAITING, FINISHED, QUEUED, LOCKED = range(6)

# what a thread's run returns; no run returns `GO_ON`
DONE, STOPPED, FULL, OPEN_SWAPS, GO_ON = range(5)


Kernel = TypeVar("Kernel", bound=Callable[..., object])


class Clock(IntEnum):
    """When a method's threads read the clock; a reading costs some 10 ns."""

    NEVER = 0
    BY_STEPS = 1  # after a location, an insertion, and before and after each wait
    BY_WAITS = 2  # when a wait begins and ends: each thread either locates or changes


@cached_njit
def now():
    """The cycle counter."""
    return cycles()


@cached_njit(forceinline=True)
def add_cycles(state, me, column, begun):
    """Add the cycles since ``begun`` to a column; returns the present one."""
    ended = cycles()
    state[me, column] += ended - begun
    return ended


@cached_njit(forceinline=True)
def stop_reason(mesh, me, with_history):
    """Why thread ``me`` has to return, if it may, or `GO_ON`.

    `STOPPED` when all threads have to stop; `FULL` when the structure has to grow first; `OPEN_SWAPS` when
    illegal edges are to be corrected. A thread that holds locks, or has subdivided, goes on. In place a step
    is a whole insertion, the structure does not grow, and all edges are legal.
    """
    if not with_history:
        return STOPPED if load(mesh.shared, (c.STOP, 0)) != 0 else GO_ON
    shared, phase = mesh.shared, mesh.state[me, c.PHASE]
    if phase == c.CHANGE:
        return GO_ON
    if load(shared, (c.STOP, 0)) != 0:
        return STOPPED
    if phase <= c.HEAD_START:
        if load(shared, (c.USED, 0)) > shared[c.SOFT_LIMIT, 0]:
            return FULL
        if load(shared, (c.SWAPS_LEFT, 0)) != 0:
            return OPEN_SWAPS
    return GO_ON


@cached_njit(forceinline=True)
def column_of(outcome):
    """Where the time of a step goes."""
    if outcome == WAITING:
        return c.WAIT_CYCLES
    return c.LOCATION_CYCLES if outcome in (LOCATED, QUEUED) else c.CHANGE_CYCLES


# a method's own, see `specialised`
step: Any = None
wait: Any = None
clock: Any = None
with_history: Any = None


@cached_njit(nogil=True)
def _run(mesh, me, tools):
    """Steps of thread ``me`` until none is left for it; `DONE`, or why it came back before."""
    mesh, tools = unowned(mesh), unowned(tools)
    waited, column = 0, c.LOCATION_CYCLES
    begun = cycles()
    while True:
        reason = stop_reason(mesh, me, with_history)
        if reason != GO_ON:
            break
        outcome = step(mesh, me, tools)
        if outcome == FINISHED:
            reason = DONE
            break
        if clock == Clock.BY_STEPS:
            if outcome != CHANGED or mesh.state[me, c.PHASE] <= c.HEAD_START:
                begun = add_cycles(mesh.state, me, column_of(outcome), begun)
        elif clock == Clock.BY_WAITS and column != column_of(outcome):
            begun = add_cycles(mesh.state, me, column, begun)
            column = column_of(outcome)
        if outcome == WAITING:
            strive(mesh, me, wait(mesh, me, waited))
            waited += 1
            if clock == Clock.BY_STEPS:
                begun = add_cycles(mesh.state, me, c.WAIT_CYCLES, begun)
        else:
            if outcome != CHANGED:
                # it may find again and again that what it looked at has changed
                strive(mesh, me, STEP)
            waited = 0
        inject_yield(mesh, me)
    if clock == Clock.BY_WAITS:
        add_cycles(mesh.state, me, column, begun)
    return reason


def specialised(template: Kernel, module: str, method: str, **own: object) -> Kernel:
    """A kernel with a method's functions in place of its global names, compiled once for each method.

    As arguments they would keep the kernel out of the cache on disk, which knows it by its module, its name
    and its types.
    """
    source = getattr(template, "py_func", template)
    name = f"{source.__name__}_{method}"
    made = FunctionType(source.__code__, source.__globals__ | own, name)
    made.__module__, made.__qualname__ = module, name
    return cast(Kernel, cached_njit(nogil=True)(made))


class Method(NamedTuple):
    """What every method offers.

    Attributes
    ----------
    tools : callable
        ``tools(store, schedule, options)`` makes the arrays that it needs beside the mesh: a NamedTuple.
    step : callable
        ``step(mesh, me, tools)``, compiled: the next step of thread ``me``, and what it has done.
    run : callable
        ``run(mesh, me, tools)``, compiled: steps to the end, and why it ended.
    """

    tools: Callable[..., tuple[object, ...]]
    step: Callable[..., int]
    run: Callable[..., int]


def method(
    tools: Callable[..., tuple[object, ...]],
    step: Callable[..., int],
    *,
    wait: Callable[..., int] = wait_in_turns,
    clock: Clock = Clock.BY_STEPS,
    with_history: bool = True,
) -> Method:
    """A method of these steps; ``wait(mesh, me, waited)`` waits a little and returns the effort."""
    module = step.__module__
    name = module.rpartition(".")[2]
    own = {"step": step, "wait": wait, "clock": clock, "with_history": with_history}
    return Method(tools, step, specialised(_run, module, name, **own))

"""Work in an arithmetic in which subnormal numbers are numbers, as exact predicates need it.

XLA computes with subnormal numbers flushed to zero, calls the host in such a thread, and threads inherit that
from the one that starts them. C's ``fesetenv`` restores the default of the thread at hand. Where it cannot be
called in the way that Linux has it, the work is done in a thread that an unchanged one has started, which
takes longer.
"""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import TypeVar

R = TypeVar("R")

SMALLEST = 5e-324  # the least subnormal number
ENVIRONMENT_BYTES = 256  # fenv_t has 32 on x86-64, 8 on AArch64
DEFAULT_ENVIRONMENT = ctypes.c_void_p(-1)  # FE_DFL_ENV of glibc and musl

_C = ctypes.CDLL(None) if sys.platform == "linux" else None
HAS_FESETENV = _C is not None and hasattr(_C, "fesetenv")


def is_whole() -> bool:
    """Whether this thread computes with subnormal numbers."""
    return SMALLEST * float(1) > 0


def in_whole_arithmetic(work: Callable[[], R]) -> R:
    """What ``work`` returns or raises, in this thread or in one of its own."""
    if is_whole():
        return work()
    if _C is not None and hasattr(_C, "fesetenv"):
        before = ctypes.create_string_buffer(ENVIRONMENT_BYTES)
        _C.fegetenv(before)
        _C.fesetenv(DEFAULT_ENVIRONMENT)
        try:
            if is_whole():
                return work()
        finally:
            _C.fesetenv(before)
    return in_unchanged_thread(work)


_TASKS: SimpleQueue[Callable[[], None] | None] = SimpleQueue()


def in_unchanged_thread(work: Callable[[], R]) -> R:
    """What ``work`` returns or raises, in a thread that one has started which `begin` has."""
    result: Future[R] = Future()

    def run() -> None:
        try:
            result.set_result(work())
        except BaseException as error:  # raised in the thread that waits
            result.set_exception(error)

    _TASKS.put(run)
    return result.result()


def begin() -> None:
    """Start the thread that starts others; in one whose arithmetic is whole."""
    threading.Thread(target=_start_each, daemon=True).start()


def end() -> None:
    """Let it end."""
    _TASKS.put(None)


def _start_each() -> None:
    while (task := _TASKS.get()) is not None:
        threading.Thread(target=task, daemon=True).start()


if not HAS_FESETENV:  # where this is imported, not where XLA calls
    begin()
    if hasattr(os, "register_at_fork"):  # not on Windows, which has no fork
        os.register_at_fork(after_in_child=begin)  # no thread but one is there

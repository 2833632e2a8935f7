"""Threads in which subnormal numbers are numbers.

XLA computes with subnormal numbers flushed to zero, and calls the host in such a thread. Threads inherit that
from the one that starts them. Exact predicates need all of floating point, so what the host does runs in
threads whose first ancestor began before.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import TypeVar

R = TypeVar("R")

_TASKS: SimpleQueue[Callable[[], None]] = SimpleQueue()


def in_whole_arithmetic(work: Callable[[], R]) -> R:
    """What ``work`` returns or raises, in a thread of its own."""
    result: Future[R] = Future()

    def run() -> None:
        try:
            result.set_result(work())
        except BaseException as error:  # raised in the thread that waits
            result.set_exception(error)

    _TASKS.put(run)
    return result.result()


def _start_each() -> None:
    while True:
        threading.Thread(target=_TASKS.get(), daemon=True).start()


def _begin() -> None:
    threading.Thread(target=_start_each, daemon=True).start()


_begin()  # as the module is imported, which is no callback
if hasattr(os, "register_at_fork"):  # not on Windows, which has no fork
    os.register_at_fork(after_in_child=_begin)  # no thread but one is there

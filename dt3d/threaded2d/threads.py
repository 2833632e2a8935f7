"""Running threads to their end, or stopping all of them: after Ctrl-C, and when one fails."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

from .._memory import room_for_threads

LOOK = 0.05  # seconds between two looks of the main thread, which a thread that ends or a signal wakes


def together(tasks: Sequence[Callable[[], Any]], stop: Callable[[], None]) -> list[Any]:
    """Run every task in a thread of its own; what they return.

    The tasks release the interpreter's lock. ``stop`` makes those that run return soon. It is called when one
    raises, and when this thread is interrupted; no thread runs any more when this function returns or raises.

    Raises
    ------
    BaseException
        What the first task to fail has raised, or what interrupted this thread.
    MemoryError
        If the system does not start as many threads.
    """
    results: list[Any] = [None] * len(tasks)
    failures: list[BaseException] = []

    ended = [threading.Event() for _ in tasks]

    def run(k: int) -> None:
        try:
            results[k] = tasks[k]()
        except BaseException as error:  # raised again below, in the thread of the caller
            failures.append(error)
            stop()
        finally:
            ended[k].set()

    # Events and not Thread.join: before Python 3.13 an interrupted join takes the thread for ended.
    started: list[threading.Event] = []
    try:
        for k in range(len(tasks)):
            with room_for_threads():
                threading.Thread(target=run, args=(k,), daemon=True).start()
            started.append(ended[k])
        for event in started:
            while not event.wait(LOOK):
                pass
    except BaseException:
        stop()
        for event in started:
            event.wait()
        raise
    if failures:
        raise failures[0]
    return results


def briefly(tasks: Sequence[Callable[[], Any]]) -> None:
    """Run tasks that are too short to be stopped; one alone without a thread of its own."""
    if len(tasks) == 1:
        tasks[0]()
    else:
        together(tasks, lambda: None)

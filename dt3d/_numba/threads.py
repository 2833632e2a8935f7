"""Running threads to their end, or stopping all of them: after Ctrl-C, and when one fails."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import TypeVar

from .._memory import FEWER_THREADS, room_for_threads

R = TypeVar("R")

SECONDS_BETWEEN_LOOKS = 0.05  # of the main thread, which a thread that ends or a signal wakes


def run_threads(
    tasks: Sequence[Callable[[], R]],
    stop: Callable[[], None],
    watch: Callable[[], object] | None = None,
    cure: str = FEWER_THREADS,
) -> list[R]:
    """Run each task in its own thread and return what they return.

    No thread runs any more when this function returns or raises.

    Parameters
    ----------
    tasks : sequence of functions
        They release the interpreter's lock.
    stop : function
        Makes the running tasks return soon. It is called when one of them raises, when ``watch`` raises, and
        when this thread is interrupted.
    watch : function, optional
        Called in this thread every `SECONDS_BETWEEN_LOOKS` while tasks run.
    cure : str
        What a user can do where the system refuses a thread.

    Raises
    ------
    BaseException
        What the first task to fail, or ``watch``, has raised, or what interrupted this thread.
    MemoryError
        If the system does not start as many threads.
    """
    results: dict[int, R] = {}
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
            with room_for_threads(cure):
                threading.Thread(target=run, args=(k,), daemon=True).start()
            started.append(ended[k])
        for event in started:
            while not event.wait(SECONDS_BETWEEN_LOOKS):
                if watch is not None:
                    watch()
    except BaseException:
        stop()
        for event in started:
            event.wait()
        raise
    if failures:
        raise failures[0]
    return [results[k] for k in range(len(tasks))]


def run_short_tasks(tasks: Sequence[Callable[[], object]], cure: str = FEWER_THREADS) -> None:
    """Run tasks that are too short to be stopped; a single one in the calling thread."""
    if len(tasks) == 1:
        tasks[0]()
    else:
        run_threads(tasks, lambda: None, cure=cure)

"""Running threads to their end, or stopping all of them: after Ctrl-C, and when one fails."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

LOOK = 0.05  # seconds between two looks of the main thread, which a thread that ends or a signal wakes


def together(tasks: Sequence[Callable[[], Any]], stop: Callable[[], None]) -> list[Any]:
    """Run every task in a thread of its own; what they return.

    The tasks release the interpreter's lock. ``stop`` makes those that run return soon. It is called when one
    raises, and when this thread is interrupted; no thread runs any more when this function returns or raises.

    Raises
    ------
    BaseException
        What the first task to fail has raised, or what interrupted this thread.
    """
    results: list[Any] = [None] * len(tasks)
    failures: list[BaseException] = []

    def run(k: int) -> None:
        try:
            results[k] = tasks[k]()
        except BaseException as error:  # noqa: BLE001  (raised again below, in the thread of the caller)
            failures.append(error)
            stop()

    threads = [threading.Thread(target=run, args=(k,), daemon=True) for k in range(len(tasks))]
    started: list[threading.Thread] = []
    try:
        for thread in threads:
            thread.start()
            started.append(thread)
        for thread in threads:
            while thread.is_alive():
                thread.join(LOOK)
    except BaseException:
        stop()
        for thread in started:
            thread.join()
        raise
    if failures:
        raise failures[0]
    return results

"""Memory that is not there is a MemoryError that says what was needed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def room_for_threads(cure: str = "ask for fewer with threads=1") -> Iterator[None]:
    """Threads are started within; where the system refuses one, that is a MemoryError with a sentence.

    ``cure``: what the caller of the library can do.

    Raises
    ------
    MemoryError
        In place of the RuntimeError by which Python says that no thread could be started.
    """
    try:
        yield
    except RuntimeError as error:
        if "can't start new thread" not in str(error):
            raise
        msg = (
            f"the system refused another thread: there is no room for its stack in this process's address "
            f"space (ulimit -v), or there are too many (ulimit -u, a container's pids limit); {cure}, or "
            f"raise the limit"
        )
        raise MemoryError(msg) from error

"""How much memory there is, for those who must know first, and errors that say what was needed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

UNKNOWN = 1 << 40
"""What is assumed where the system does not tell: no limit."""


def available_memory() -> int:
    """Bytes that can be taken without swapping, as Linux estimates it, within the limit of a container."""
    free = UNKNOWN
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                free = int(line.split()[1]) << 10
    except (OSError, ValueError, IndexError):
        try:
            free = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        except (AttributeError, OSError, ValueError):
            return UNKNOWN
    try:
        group = Path("/sys/fs/cgroup")
        used = int((group / "memory.current").read_text())
        return min(free, max(0, int((group / "memory.max").read_text()) - used))
    except (OSError, ValueError):  # no container, or one without a limit ("max")
        return free


def gigabytes(size: int) -> str:
    """A number of bytes for a message: ``2.5 GB``."""
    return f"{size / 1e9:.1f} GB" if size >= 1e8 else f"{size / 1e6:.1f} MB"


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

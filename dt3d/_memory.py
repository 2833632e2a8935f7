"""Memory that is not there is a MemoryError that says what was needed, before it is taken.

Linux gives memory out that it does not have, and ends the process that writes to it. So what a step is known
to write is compared with what there is: free memory of the machine and of the container, and address space.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

UNKNOWN = 1 << 60  # bytes; what is assumed where the system does not tell: no limit
MARGIN = 64 << 20  # bytes left to all else
FEWER_THREADS = "ask for fewer with threads=1"
SMALL = 32 << 20  # bytes that are not worth a look, which takes up to a millisecond


def require(what: str, written: float, reserved: float | None = None) -> None:
    """See that there is memory for what comes next, if that is much.

    Parameters
    ----------
    what
        The subject of the sentence: "the triangulation of 1000 sites".
    written
        Bytes that will be written and so take memory, beside what is taken already.
    reserved
        Bytes of address space, if not as many; memory that is never written takes no other.

    Raises
    ------
    MemoryError
        If there is less.
    """
    reserved = written if reserved is None else reserved
    if max(written, reserved) < SMALL:
        return
    for need, there, where in (
        (written, available_memory(), "available"),
        (reserved, address_space(), "left of this process's address space (ulimit -v)"),
    ):
        need += MARGIN
        if need > there:
            msg = f"{what} needs about {gigabytes(need)} more memory, and {gigabytes(there)} are {where}"
            raise MemoryError(msg)


def available_memory(root: Path = Path("/")) -> int:
    """Bytes that this process can take before the system ends it, the limits of containers included.

    ``root`` is where the system's files are.
    """
    return max(0, min(_of_machine(root), *_of_containers(root)))


def gigabytes(size: float) -> str:
    """A number of bytes for a message: ``2.5 GB``."""
    return f"{size / 1e9:.1f} GB" if size >= 1e8 else f"{size / 1e6:.1f} MB"


def address_space() -> int:
    """Bytes that this process may still reserve under its limit (ulimit -v)."""
    try:
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        if limit == resource.RLIM_INFINITY:
            return UNKNOWN
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        return max(0, limit - pages * resource.getpagesize())
    except (ImportError, OSError, ValueError):
        return UNKNOWN


def _of_machine(root: Path) -> int:
    try:
        lines = dict(line.split(":") for line in (root / "proc/meminfo").read_text().splitlines())
        return 1024 * sum(int(lines[name].split()[0]) for name in ("MemAvailable", "SwapFree"))
    except (OSError, ValueError, KeyError):
        pass
    try:
        import psutil  # not of this package; for systems without these files, where somebody has it
    except ImportError:
        return UNKNOWN
    return int(psutil.virtual_memory().available)


def _of_containers(root: Path) -> Iterator[int]:
    """What the control groups of this process, and those around them, leave it; of version 2 and 1."""
    yield UNKNOWN
    try:
        groups = [line.split(":", 2) for line in (root / "proc/self/cgroup").read_text().splitlines()]
    except OSError:
        return
    for _, controllers, path in (g for g in groups if len(g) == 3):
        if controllers == "":
            mount, limit, usage, unused = "", "memory.max", "memory.current", "inactive_file"
        elif "memory" in controllers.split(","):
            mount, limit, usage = "memory", "memory.limit_in_bytes", "memory.usage_in_bytes"
            unused = "total_inactive_file"
        else:
            continue
        top = root / "sys/fs/cgroup" / mount
        group = top / path.lstrip("/")
        for folder in (group, *group.parents):
            yield _of_group(folder, limit, usage, unused)
            if folder == top:
                break


def _of_group(folder: Path, limit: str, usage: str, unused: str) -> int:
    """What is left of the limit of one group, where it has one; files that are only cached can go."""
    try:
        most = int((folder / limit).read_text())  # "max" is no number
        taken = int((folder / usage).read_text())
    except (OSError, ValueError):
        return UNKNOWN
    try:
        stat = dict(line.split() for line in (folder / "memory.stat").read_text().splitlines())
        taken -= int(stat.get(unused, 0))
    except (OSError, ValueError):
        pass
    return most - taken


@contextmanager
def room_for_threads(cure: str = FEWER_THREADS) -> Iterator[None]:
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

"""Compiling in a second process, on the first call of a new machine, what this one will need next.

numba compiles one function at a time in a process. Where nothing of an engine is on disk yet, another process
compiles its largest kernel meanwhile, and this one then finds it there. The other goes on with what is needed
less often, until it is done or this process ends. If that does not work, for whatever reason, this process
compiles as ever.
"""

from __future__ import annotations

import atexit
import os
import subprocess
import sys
import threading
from collections.abc import Callable

from .announce import announce
from .cores import available_cores
from .kept import Kept
from .kernel_cache import is_kept

# after ``python -c``: where packages are, a module, and two of its functions, without arguments
PROGRAM = """
import importlib, sys
sys.path[:] = {path!r}
module = importlib.import_module({module!r})
module.{function}()
print(flush=True)
module.{afterwards}()
"""


CHILDREN: set[subprocess.Popen[bytes]] = set()
"""Processes that may still compile."""


@atexit.register
def end_all() -> None:
    """Leave no process."""
    for child in tuple(CHILDREN):
        _end(child)


def _end(child: subprocess.Popen[bytes]) -> None:
    child.kill()
    child.wait()
    CHILDREN.discard(child)


def _attend(child: subprocess.Popen[bytes], kept: threading.Event) -> None:
    """Note when the kernel is on disk, and when the process ends; nothing of it stays open."""
    assert child.stdout is not None
    with child.stdout as said:
        said.read(1)  # nothing, where it has ended without the kernel
    kept.set()
    child.wait()
    CHILDREN.discard(child)


def _nothing() -> None:
    """What is to be waited for where there is no process."""


def _is_python(path: str | None) -> bool:
    """Whether that is an interpreter, and not a program that has one in it."""
    return path is not None and os.path.basename(path).startswith(("python", "pypy")) and os.path.isfile(path)


def compiled_beside(
    kernel: Callable[..., object],
    module: str,
    function: str,
    afterwards: str,
    meanwhile: Callable[[], None],
) -> Callable[[], None]:
    """Begin to compile a kernel in a process of its own, unless that is needless or in vain.

    Parameters
    ----------
    kernel : function
        Compiled by `cached_njit`, always for arguments of the same types.
    module, function : str
        The function of a module, without arguments, that compiles it for these.
    afterwards : str
        The one that then compiles more.
    meanwhile : function
        Called in this process while it would wait for the other.

    Returns
    -------
    function
        To be called before the kernel is: waits until it is on disk, or the process has ended without it.
    """
    if (
        getattr(kernel, "overloads", True)  # in memory already, or numba compiles nothing
        or available_cores() < 2
        or not Kept.anywhere
        or not _is_python(sys.executable)
        or is_kept(kernel)
    ):
        return _nothing
    program = PROGRAM.format(path=sys.path, module=module, function=function, afterwards=afterwards)
    silent = subprocess.DEVNULL
    try:
        child = subprocess.Popen(
            [sys.executable, "-c", program], stdin=silent, stdout=subprocess.PIPE, stderr=silent
        )
    except OSError:
        return _nothing
    announce(module)
    CHILDREN.add(child)
    kept = threading.Event()
    threading.Thread(target=_attend, args=(child, kept), daemon=True).start()

    def wait() -> None:
        try:
            meanwhile()
            kept.wait()
        except BaseException:  # Ctrl-C
            _end(child)
            raise

    return wait

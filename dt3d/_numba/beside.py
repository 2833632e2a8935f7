"""Compiling in a second process, on the first call of a new machine, what this one will need next.

numba compiles one function at a time in a process. Where nothing of an engine is on disk yet, another process
compiles its largest kernel meanwhile, and this one then finds it there. If that does not work, for whatever
reason, this process compiles as ever.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable

from .announce import announce
from .cores import available_cores
from .kernel_cache import Kept, is_kept

# the words after ``python -c``: where packages are, a module, and its function without arguments
PROGRAM = "import sys, importlib; sys.path[:] = {path!r}; importlib.import_module({module!r}).{function}()"


def _is_python(path: str | None) -> bool:
    """Whether that is an interpreter, and not a program that has one in it."""
    return path is not None and os.path.basename(path).startswith(("python", "pypy")) and os.path.isfile(path)


def compiled_beside(kernel: Callable[..., object], module: str, function: str) -> Callable[[], None]:
    """Begin to compile a kernel in a process of its own, unless that is needless or in vain.

    Parameters
    ----------
    kernel : function
        Compiled by `cached_njit`, always for arguments of the same types.
    module, function : str
        The function of a module, without arguments, that compiles it for these.

    Returns
    -------
    function
        To be called before the kernel is: waits until the process has ended.
    """
    if (
        getattr(kernel, "overloads", True)  # in memory already, or numba compiles nothing
        or available_cores() < 2
        or not Kept.anywhere
        or not _is_python(sys.executable)
        or is_kept(kernel)
    ):
        return lambda: None
    program = PROGRAM.format(path=sys.path, module=module, function=function)
    silent = subprocess.DEVNULL
    try:
        child = subprocess.Popen([sys.executable, "-c", program], stdin=silent, stdout=silent, stderr=silent)
    except OSError:
        return lambda: None
    announce(module)

    def wait() -> None:
        try:
            child.wait()
        except BaseException:  # Ctrl-C
            child.kill()
            child.wait()
            raise

    return wait

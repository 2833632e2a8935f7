"""The command ``dt3d`` from its first moment on; it loads next to nothing before Ctrl-C is taken care of.

Loading dt3d and JAX takes a second, in which Python would answer Ctrl-C with a traceback. This package lies
outside of dt3d because whatever lies inside loads that first.
"""

from __future__ import annotations

import atexit
import os
import signal
import sys


def main() -> int:
    """Run the command line with the words of the process; returns its exit status (`dt3d.cli.main`)."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # not where it is to be ignored
        signal.signal(signal.SIGINT, _leave)  # until the commands take over, and after they have ended
    # the last of what is called at the end; Python itself would let another Ctrl-C kill the process then
    atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    _occupy_standard_streams()
    try:
        from dt3d.cli import main as run
    except ImportError as error:
        print(f"dt3d: {' '.join(str(error).split())}", file=sys.stderr)
        return 2
    status = run()
    if status == 130:  # what libraries are still about is not waited for: their ends can hang then, or crash
        os._exit(status)
    return status


def _leave(*_: object) -> None:
    """Nothing is being written: the process can end as it stands."""
    try:
        os.write(2, b"interrupted\n")
    finally:
        os._exit(130)


def _occupy_standard_streams() -> None:
    """Where a standard stream is closed, no file that is opened later may get its number, and its lines."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free

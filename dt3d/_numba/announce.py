"""Why the first call takes long: numba compiles, once, and keeps the result on disk.

It goes to the logger "dt3d" as a warning, which is printed to stderr where nobody has configured logging, as
JAX does for what a user should know. ``logging.getLogger("dt3d").setLevel("ERROR")`` silences it.
"""

from __future__ import annotations

import functools
import logging

from .kernel_cache import CURE, Kept

MESSAGE = "compiling, which takes some ten to forty seconds once; numba keeps the result on disk"
NOT_KEPT = (
    "compiling, which takes some ten to forty seconds in every process, for neither the package's folder nor "
    f"the user's cache folder can be written; {CURE}"
)


@functools.cache
def announce_compilation() -> None:
    """Announce, from now on, the first function of dt3d that numba has to compile.

    What numba has on disk is not announced.
    """
    from numba.core import event

    class Announcer(event.Listener):
        announced = False

        def on_start(self, event: event.Event) -> None:
            module = event.data["dispatcher"].py_func.__module__
            if not self.announced and module.partition(".")[0] == "dt3d":
                self.announced = True
                logging.getLogger("dt3d").warning(MESSAGE if Kept.anywhere else NOT_KEPT)

        def on_end(self, event: event.Event) -> None:
            pass

    event.register("numba:compile", Announcer())

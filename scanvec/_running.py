"""Where JAX runs what machines do: with 64 bits, and not in a process that was forked after JAX had run.

XLA computes in threads of its own, which a fork does not copy; its child would wait for them for ever.
"""

from __future__ import annotations

import os
import sys
from contextlib import AbstractContextManager

import jax


class _Process:
    has_run = False  # JAX, in this process or the one it was forked from
    forked = False  # since then


def computing() -> AbstractContextManager[None]:
    """A context in which vectors keep 64 bits; for all that JAX is asked to do.

    Raises
    ------
    RuntimeError
        In a process that was forked after JAX had run in its parent.
    """
    if _Process.forked:
        msg = (
            "this process was forked after JAX had run in its parent; JAX's threads are missing here, and "
            "what waits for them never ends: start processes with multiprocessing.get_context('spawn'); what "
            "does not run on JAX works here"
        )
        raise RuntimeError(msg)
    _Process.has_run = True
    with_64_bits: AbstractContextManager[None] = jax.enable_x64(True)
    return with_64_bits


def _before_fork() -> None:
    """See whether others have used JAX; where it does not tell, what machines did is known."""
    bridge = sys.modules.get("jax._src.xla_bridge")
    initialized = getattr(bridge, "backends_are_initialized", None)
    if initialized is not None and initialized():
        _Process.has_run = True


def _in_child() -> None:
    _Process.forked = _Process.has_run


if hasattr(os, "register_at_fork"):  # not on Windows, which has no fork
    os.register_at_fork(before=_before_fork, after_in_child=_in_child)

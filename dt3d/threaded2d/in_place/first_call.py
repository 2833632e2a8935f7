"""The first call of a new machine: another process compiles the steps in place, half of all there is.

Then that process compiles what sites in general position hardly ever ask for.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from ..._numba.beside import compiled_beside
from ...predicates.layout import IN_CIRCLE_OPEN, ORIENT2D_OPEN
from ...predicates.open_stages import FUNCTIONS
from ..compaction import compact
from ..mesh import ROOTS, Store
from ..work_sharing import share
from .cavity import empty_scratch
from .star import METHOD, Tools

FIRST = np.arange(3)


def _store() -> Store:
    return Store(np.zeros((3, 2)), FIRST, 1, ROOTS)


def compile_steps() -> None:
    """Compile them for the types that arguments have, or load them from disk."""
    tools = Tools(share(np.empty(0, np.int64), np.zeros(2, np.int64)), empty_scratch(3, 1))
    kernel: Any = METHOD.run
    kernel.compile(tuple(map(numba.typeof, (_store().mesh(), 0, tools))))


def compile_ties() -> None:
    """Compile what decides ties; a grid asks for orientations first, so they are last."""
    for place in (IN_CIRCLE_OPEN, ORIENT2D_OPEN):
        FUNCTIONS.address(place)


def compile_compaction() -> None:
    """Compile it by calling it for the first triangle."""
    compact(_store().nodes, FIRST)


def steps_beside() -> Callable[[], None]:
    """Begin to compile the steps elsewhere, if they have to be; returns what waits for them."""
    names = compile_steps.__name__, compile_ties.__name__
    return compiled_beside(METHOD.run, __name__, *names, compile_compaction)

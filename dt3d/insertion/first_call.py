"""The first call of a new machine: another process compiles `insert`, half of what there is to compile.

Then that process compiles what sites in general position hardly ever ask for.
"""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np

from .._numba.beside import compiled_beside
from ..predicates.layout import CONFLICTS, IN_SPHERE_OPEN, LINK_WIDE, ORIENT3D_OPEN
from ..predicates.open_stages import FUNCTIONS
from .compaction import count_finite, number_finite, write_finite
from .insert import insert
from .store import Store
from .worker import Scale, scratch_for


def _store() -> Store:
    return Store(np.zeros(16), np.arange(4, dtype=np.int32), slots=5, block=1)


def compile_insert() -> None:
    """Compile it for the types that arguments have, or load it from disk."""
    todo, state, work = np.empty(0, np.uint32), np.empty(0, np.int64), np.empty(0)
    arguments = _store().mesh, todo, state, scratch_for(1), Scale(0.0, 0.0), work
    insert.compile(tuple(map(numba.typeof, arguments)))


def compile_the_rest() -> None:
    """Compile what a run needs beside `insert`: ghosts' conflicts, and the compaction, of no tetrahedra."""
    FUNCTIONS.address(CONFLICTS)
    mesh, number = _store().mesh, np.empty(0, np.int32)
    out = np.empty((0, 4), np.int32)
    count_finite(mesh, 0, 0)
    number_finite(mesh, 0, 0, 0, number)
    write_finite(mesh, 0, 0, number, number, out, out)


def compile_seldom() -> None:
    """Compile what ties and large stars need; a grid asks for orientations first, so they are last."""
    for place in (IN_SPHERE_OPEN, ORIENT3D_OPEN, LINK_WIDE):
        FUNCTIONS.address(place)


def insert_beside() -> Callable[[], None]:
    """Begin to compile `insert` elsewhere, if it has to be; returns what waits for it."""
    names = compile_insert.__name__, compile_seldom.__name__
    return compiled_beside(insert, __name__, *names, compile_the_rest)

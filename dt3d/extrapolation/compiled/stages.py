"""The stages of an open face, what becomes of it in one, and the records that go through them."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from ..faces import Face
from ..warrants import NO_SITE


class Stage(IntEnum):
    """Where open faces are expanded; a face that one stage leaves open goes on to another.

    ========== ============================== ============================== ================= ===========
    stage      searches                       file                           `WIDER` goes to   `TIE` goes to
    ========== ============================== ============================== ================= ===========
    WINDOW     a window of 3 x 3 x 3 cells    `window_search.py`             CAP               TIES
    CAP        all cells that its cap meets   `cap_search.py`                VECTORS           TIES
    TIES       a window, by integers          `exact_ties.py`                VECTORS           never
    VECTORS    as the vectors do              `vectors.py`                   never             never
    ========== ============================== ============================== ================= ===========

    All faces begin in WINDOW. A wave is of the least stage in which enough faces wait, else of the least in
    which any do.
    """

    WINDOW = 0
    CAP = 1
    TIES = 2
    VECTORS = 3


# Where the faces go for which a stage has not searched enough.
WIDER_STAGE = {
    Stage.WINDOW: Stage.CAP,
    Stage.CAP: Stage.VECTORS,
    Stage.TIES: Stage.VECTORS,
    Stage.VECTORS: Stage.VECTORS,
}

# What becomes of a face: a fourth vertex, none, more sites to search, or several sites that the bounds leave.
FOUND, HULL, WIDER, TIE = 0, 1, 2, 3


class Batch(NamedTuple):
    """Open faces taken from a queue, in arrays that have room for a wave of them."""

    half: Array  # int32: the half-faces behind them
    face: Face[Array]  # int32: vertices as seen from the open side
    bound: Array  # float64: an upper bound of the signed distance
    filled: Array  # how many there are


class Expansion(NamedTuple):
    """The outcome for each face of a batch."""

    site: Array  # int32; NO_SITE unless found
    status: Array  # int32: FOUND, HULL, WIDER, TIE
    low: Array  # lower bound of the signed distance; inf for the hull, -inf where undecided
    high: Array  # the candidate's upper bound


def nothing_known(size: int) -> Expansion:
    """What is known of faces before they are expanded."""
    return Expansion(
        jnp.full(size, NO_SITE, jnp.int32),
        jnp.full(size, WIDER, jnp.int32),
        jnp.full(size, -jnp.inf),
        jnp.full(size, jnp.inf),
    )


def settle(covered: Array, alone: Array, some: Array, candidate: Array, low: Array, high: Array) -> Expansion:
    """What becomes of faces: the region searched, no rival left, a candidate and its bounds."""
    decided = jnp.where(alone, jnp.where(some, FOUND, HULL), TIE)
    status = jnp.where(covered, decided, WIDER).astype(jnp.int32)
    return Expansion(
        jnp.where(status == FOUND, candidate, NO_SITE),
        status,
        jnp.where(status <= HULL, low, -jnp.inf),
        high,
    )

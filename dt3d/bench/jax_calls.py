"""Triangulations inside JAX programs beside direct calls: what a callback costs, and what a batch gains."""

from __future__ import annotations

import hashlib
from statistics import median
from typing import TYPE_CHECKING

import numpy as np

from .._numba.threads import run_short_tasks
from .pairs import Pair, in_turn

if TYPE_CHECKING:
    from ..delaunay import Delaunay
    from ..jax import Mesh


def pairs(rounds: int, quick: bool) -> list[Pair]:
    """One set under jit, one in each dimension and size; and a batch under vmap beside a Python loop.

    The other is `dt3d.Delaunay` in each pair, so its time is that of ours without JAX.
    """
    sizes = (200, 1000) if quick else (1000, 10_000, 100_000)
    measured = [_one_set(n, d, rounds) for d in (3, 2) for n in sizes]
    return [*measured, _batch(*((4, 200) if quick else (64, 1500)), rounds)]


def _one_set(n: int, d: int, rounds: int) -> Pair:
    import jax

    from ..delaunay import Delaunay
    from ..jax import delaunay

    points = np.random.default_rng(0).random((n, d))
    with jax.enable_x64(True):
        given, program = jax.numpy.asarray(points), jax.jit(delaunay)
        program(given)
        seconds = in_turn(
            lambda: jax.block_until_ready(program(given)), lambda: Delaunay(points), max(rounds, 5)
        )
        same = _same(program(given), Delaunay(points))
    where = "in space" if d == 3 else "in the plane"
    return Pair(f"jit {where}", f"{n:,} sites", "direct call", *seconds, same)


def _batch(sets: int, n: int, rounds: int) -> Pair:
    import jax

    from ..delaunay import Delaunay
    from ..jax import delaunay

    points = np.random.default_rng(0).random((sets, n, 3))
    with jax.enable_x64(True):
        given, program = jax.numpy.asarray(points), jax.jit(jax.vmap(delaunay))
        seconds = in_turn(
            lambda: jax.block_until_ready(program(given)),
            lambda: [Delaunay(each) for each in points],
            rounds,
        )
        gain = f"two threads do {gain_of_two_threads():.2f} times the work of one here"
    last = jax.tree.map(lambda a: a[-1], program(given))
    note = f"{_same(last, Delaunay(points[-1]))}; {gain}"
    return Pair("vmap in space", f"{sets} sets of {n:,} sites", "loop of calls", *seconds, note)


def gain_of_two_threads(rounds: int = 5) -> float:
    """What a second thread gains on this machine at best: with hashes, which use no memory. Up to 2.

    Less where two cores of a virtual machine are one of a real one, or its clock slows down.
    """
    data = bytes(1 << 26)  # some fifty milliseconds, so that the system finds both cores

    def hash_it() -> None:
        hashlib.sha256(data)

    def by_two() -> None:
        run_short_tasks([hash_it, hash_it])

    two, one = in_turn(by_two, hash_it, rounds)
    return 2 * median(one) / median(two)


def _same(mesh: Mesh, tri: Delaunay) -> str:
    """Whether both have the same simplices; threads may have numbered them in another order."""
    ours = np.asarray(mesh.simplices)[: int(mesh.count)]
    rows = [np.sort(simplices, axis=1) for simplices in (ours, tri.simplices)]
    first, second = (r[np.lexsort(r.T)] for r in rows)
    return "the same simplices" if np.array_equal(first, second) else "other simplices"

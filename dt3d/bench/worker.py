"""A process for one library and one set: it loads, warms up, and then triangulates whenever it is told to.

A library that crashes or takes too long ends with its process and nothing else does, and what it leaves in
memory is not charged to another.
"""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from typing import Any, TypeVar

import numpy as np

from . import memory
from .peers import PEERS

T = TypeVar("T")

WARM = 20_000  # uniform sites at most, and a grid, that a library has triangulated before it is timed
LOADING = 300.0  # seconds that loading, compiling and warming up may take


@dataclass(frozen=True)
class Run:
    """One triangulation: seconds, tetrahedra, and bytes at the peak above what was in use before."""

    seconds: float
    tetrahedra: int
    memory: int | None


@dataclass(frozen=True)
class Ended:
    """Why there is no answer: "> 60 s", "crashed", or what was raised."""

    why: str


class Worker:
    """A library at work on ``points``, float64 (n, 3)."""

    def __init__(self, peer: str, threads: int | None, points: np.ndarray) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=serve, args=(theirs, peer, threads), daemon=True)
        with _without_interrupts():
            self.process.start()
        theirs.close()
        self.points: np.ndarray | None = points

    def ready(self) -> Ended | None:
        """Wait until it is warm; what was wrong, if something was."""
        answer = self._ask(self.points, LOADING)
        self.points = None
        return answer if isinstance(answer, Ended) else None

    def run(self, limit: float) -> Run | Ended:
        """Triangulate, within so many seconds."""
        answer: Run | Ended = self._ask("run", limit)
        return answer

    def verify(self) -> bool | Ended | None:
        """Whether the last result is the Delaunay triangulation; None where the library does not show it."""
        answer: bool | Ended | None = self._ask("verify", None)
        return answer

    def end(self) -> None:
        """Stop it, whatever it does."""
        self.process.kill()
        self.process.join()
        self.connection.close()

    def _ask(self, question: object, limit: float | None) -> Any:
        try:
            self.connection.send(question)
            if not self.connection.poll(limit):
                self.process.kill()
                return Ended(f"> {limit:g} s")
            return self.connection.recv()
        except (EOFError, OSError):
            return Ended("crashed")


@contextlib.contextmanager
def _without_interrupts() -> Iterator[None]:
    """A process that is started now does not hear Ctrl-C; its parent does, and ends it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # or it starts now, and hears signals again when it has
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:  # what came meanwhile is delivered to this process
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def serve(connection: Connection, peer: str, threads: int | None) -> None:
    """What the process does: answers the questions that come, in order, until none comes."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # some libraries talk
    try:
        points = connection.recv()
        ready = _or_ended(lambda: _Ready(peer, threads, points))
        if isinstance(ready, Ended):
            connection.send(ready)
            return
        connection.send(None)
        while True:
            work = ready.verify if connection.recv() == "verify" else ready.run
            connection.send(_or_ended(work))
    except EOFError:
        return


def _or_ended(work: Callable[[], T]) -> T | Ended:
    """What the work returns, or what it raises as an answer."""
    try:
        return work()
    except Exception as error:
        return Ended(f"{type(error).__name__}: {error}")


class _Ready:
    """A library that is loaded and warm, and the points as it takes them."""

    def __init__(self, peer: str, threads: int | None, points: np.ndarray) -> None:
        self.calls = PEERS[peer].load(threads)
        uniform = np.random.default_rng(0).random((max(100, min(len(points), WARM)), 3))
        for warm in (uniform, np.indices((5, 5, 5)).reshape(3, -1).T.astype(float)):
            self.calls.tetrahedra(self.calls.triangulate(self.calls.prepare(warm)))
        self.points = points
        self.prepared = self.calls.prepare(points)
        self.result: Any = None

    def run(self) -> Run:
        self.result = None
        gc.collect()
        before = memory.resident() if memory.forget_peak() else None
        begun = time.perf_counter()
        self.result = self.calls.triangulate(self.prepared)
        seconds = time.perf_counter() - begun
        most = memory.peak()
        used = None if before is None or most is None else most - before
        return Run(seconds, self.calls.tetrahedra(self.result), used)

    def verify(self) -> bool | None:
        if self.calls.simplices is None:
            return None
        return verified(self.points, self.calls.simplices(self.result))


def verified(points: np.ndarray, simplices: np.ndarray) -> bool:
    """Whether simplices, int (m, 4), of either orientation are the Delaunay triangulation; a proof."""
    from ..verification import verify

    return bool(verify(points, simplices))

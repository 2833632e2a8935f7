"""Rounds: in each, every library triangulates the set once, so that what disturbs one disturbs all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median

from .peers import PEERS
from .sets import Sites
from .worker import Ended, Run, Worker


@dataclass(frozen=True)
class Limits:
    """How often a set is triangulated, and how many seconds a library may take.

    One that took longer than ``seconds`` in all is not asked again; one that takes longer at once is ended.
    """

    repeats: int = 5
    seconds: float = 60.0


@dataclass(frozen=True)
class Measured:
    """A library on a set.

    Attributes
    ----------
    label : str
        The library's name; of dt3d with the number of threads, where several were asked for.
    runs : tuple of float
        Seconds of each round.
    tetrahedra : int
    memory : int or None
        Bytes at the peak of its first round above what was in use before, which is the input and what was
        imported.
    verified : bool or None
        Whether exact arithmetic proved the result; None if it was not asked to, or could not be.
    ended : str
        Why there are no runs, or no more: "> 60 s", "crashed", or the error.
    """

    set_name: str
    sites: int
    label: str
    runs: tuple[float, ...]
    tetrahedra: int
    memory: int | None
    verified: bool | None
    ended: str

    @property
    def seconds(self) -> float | None:
        """The median."""
        return median(self.runs) if self.runs else None


def compare(
    sites: Sites,
    against: Sequence[str],
    threads: Sequence[int | None],
    limits: Limits,
    verify: bool = False,
    say: Callable[[str], object] = lambda _: None,
) -> list[Measured]:
    """Triangulate a set with dt3d, once for each number of threads, and with the peers named (`PEERS`).

    ``say`` is told what is going on. dt3d with the first number of threads comes first.

    Raises
    ------
    ValueError
        If a peer is unknown or not installed.
    """
    for name in against:
        if name not in PEERS or not PEERS[name].installed:
            msg = f"{name!r} is not among the libraries that are installed here: {', '.join(installed())}"
            raise ValueError(msg)
    names = [f"dt3d, {k} thread{'s' * (k != 1)}" if len(threads) > 1 else "dt3d" for k in threads]
    asked = [(label, "dt3d", k) for label, k in zip(names, threads, strict=True)]
    asked += [(name, name, threads[0]) for name in against if name != "dt3d"]
    lines: list[_Line] = []
    try:
        for label, peer, count in asked:
            say(f"{sites.name}, {len(sites.points):,} sites: {label} warms up")
            lines.append(_Line(label, Worker(peer, count, sites.points)))
        for line in lines:
            line.ended = line.worker.ready()
        for turn in range(limits.repeats):
            for line in lines:
                if line.ended is None and sum(run.seconds for run in line.runs) <= limits.seconds:
                    say(f"{sites.name}, {len(sites.points):,} sites: {line.label}, round {turn + 1}")
                    line.run(limits.seconds)
        if verify:
            for line in lines:
                say(f"{sites.name}, {len(sites.points):,} sites: {line.label} is verified")
                line.verify()
    finally:
        for line in lines:
            line.worker.end()
    return [line.measured(sites) for line in lines]


def installed() -> list[str]:
    """The names of the libraries that can be compared here."""
    return [name for name, peer in PEERS.items() if peer.installed]


class _Line:
    """A worker, and what it has answered."""

    def __init__(self, label: str, worker: Worker) -> None:
        self.label, self.worker = label, worker
        self.runs: list[Run] = []
        self.ended: Ended | None = None
        self.verified: bool | None = None

    def run(self, limit: float) -> None:
        answer = self.worker.run(limit)
        if isinstance(answer, Ended):
            self.ended = answer
        else:
            self.runs.append(answer)

    def verify(self) -> None:
        if self.ended is None:
            answer = self.worker.verify()
            if isinstance(answer, Ended):
                self.ended = answer
            else:
                self.verified = answer

    def measured(self, sites: Sites) -> Measured:
        first = self.runs[0] if self.runs else Run(0.0, 0, None)
        return Measured(
            sites.name,
            len(sites.points),
            self.label,
            tuple(run.seconds for run in self.runs),
            first.tetrahedra,
            first.memory,
            self.verified,
            "" if self.ended is None else self.ended.why,
        )

"""Fuzzing: point sets drawn at random from families that are hard, and files that are broken at random.

    python -m tests.fuzz --seconds 60
    python -m tests.fuzz --repeat out/fuzz/crowded-3d-17.npz

Trials run in other processes, so hanging and dying are failures like others. A set that fails is made smaller
as long as it fails, and saved with the line that repeats it. The exit status is 1 if anything failed.
"""

from __future__ import annotations

import itertools
import os
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cyclopts
import numpy as np
from rich.console import Console
from rich.table import Table

from .families import ALL, draw
from .files import corrupted, file_trial, samples
from .minimise import minimise
from .trials import trial
from .worker import Worker

PATIENCE = 120.0  # seconds for one input; the slowest takes some ten, more where an extrapolation is compiled
MINIMISING = 60.0  # seconds for making one failing set smaller
MOST_FAILURES = 20  # after which there is no point in going on
SIMPLEX = [(np.eye(d + 1, d), seed) for d in (2, 3) for seed in range(2)]  # compiles most of what is used

app = cyclopts.App(name="fuzz", help=__doc__)
console = Console(highlight=False, soft_wrap=True)


@dataclass(frozen=True)
class Case:
    """One input: the function that tries it, and its arguments. The first one of `trial` is a point set."""

    family: str
    function: Callable[..., list[str]]
    arguments: tuple[Any, int]


class Tally:
    """What was tried, by family, in how many ways, and what failed."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.inputs: Counter[str] = Counter()
        self.ways: Counter[str] = Counter()
        self.refused: Counter[str] = Counter()
        self.failures: list[str] = []

    def add(self, family: str, ways: list[str]) -> None:
        with self.lock:
            self.inputs[family] += 1
            self.refused[family] += "refused" in ways
            self.ways.update(ways)

    def fail(self, line: str) -> None:
        with self.lock:
            self.failures.append(line)
        console.print(line, markup=False)

    def table(self) -> Table:
        table = Table(title="Inputs by family", title_justify="left")
        table.add_column("family")
        table.add_column("inputs", justify="right")
        table.add_column("refused, rightly", justify="right")
        for family in sorted(self.inputs):
            table.add_row(family, f"{self.inputs[family]:,}", f"{self.refused[family]:,}")
        table.add_section()
        table.add_row("in all", f"{self.inputs.total():,}", f"{self.refused.total():,}")
        return table


def size(rng: np.random.Generator, family: str) -> int:
    """Mostly few sites, where the oracle is fast and everything is near the hull; sometimes some hundreds."""
    sizes = [rng.integers(3, 30), rng.integers(20, 90), rng.integers(150, 400)]
    # more than 128 sites in one cell take a way of their own
    return int(rng.choice(sizes, p=[0.4, 0.3, 0.3] if family == "crowded" else [0.7, 0.27, 0.03]))


def point_sets(seed: int) -> Iterator[Case]:
    """Point sets without end; equal for equal seeds."""
    for k in itertools.count():
        rng = np.random.default_rng([seed, k])
        family, d = list(ALL)[k // 2 % len(ALL)], 2 + k % 2
        points = draw(rng, family, d, size(rng, family))
        if len(points):
            yield Case(f"{family} {d}D", trial, (points, k))


def broken_files(seed: int) -> Iterator[Case]:
    """Broken files without end; equal for equal seeds."""
    for k in itertools.count(seed << 24):
        for name in samples():
            yield Case(f"file {name}", file_trial, (name, k))


def everything(seed: int) -> Iterator[Case]:
    """Point sets and broken files in turn."""
    for cases in zip(point_sets(seed), broken_files(seed), strict=False):
        yield from cases


def fuzz(cases: Iterator[Case], lock: threading.Lock, until: float, out: Path, tally: Tally) -> None:
    """Try cases until the time is over; one thread of several."""
    # broken files get a process of their own, whose memory is limited
    workers = {trial: Worker(trial, PATIENCE, SIMPLEX), file_trial: Worker(file_trial, PATIENCE, [])}
    try:
        while time.monotonic() < until and len(tally.failures) < MOST_FAILURES:
            with lock:
                case = next(cases)
            outcome, what = workers[case.function].run(*case.arguments)
            tally.add(case.family, what if outcome == "done" else [])
            if outcome != "done":
                tally.fail(_kept(case, outcome, what, out))
    finally:
        for worker in workers.values():
            worker.end()


def _kept(case: Case, outcome: str, what: str, out: Path) -> str:
    """Save a case that failed; what to print about it."""
    first, k = case.arguments
    path = out / f"{case.family.replace(' ', '-').lower()}-{k}.npz"
    if case.function is trial:
        least = _made_smaller(first, k, outcome, what)
        np.savez(path, points=least, seed=k, original=first)
        size = f"{len(first)} sites ({len(least)} after minimising)"
    else:
        kind, data = corrupted(first, k)
        np.savez(path, name=first, seed=k, data=np.frombuffer(data, np.uint8))
        size = f"{kind}, {len(data)} bytes"
    repeat = f"{Path(sys.executable).name} -m tests.fuzz --repeat {path}"
    return f"FAILED: {case.family}, {size}: {what}\n  repeat with: {repeat}"


def _made_smaller(points: np.ndarray, k: int, outcome: str, what: str) -> np.ndarray:
    """Rows that fail in the same way."""
    worker = Worker(trial, 10.0 if outcome == "hangs" else PATIENCE, SIMPLEX)
    sentence = what.partition(" (")[0]

    def fails(fewer: np.ndarray) -> bool:
        again, why = worker.run(fewer, k)
        return again == outcome and (outcome != "failed" or why.startswith(sentence))

    try:
        return minimise(points, fails, MINIMISING)
    finally:
        worker.end()


def run_again(path: Path) -> list[str]:
    """Try what was saved, in this process."""
    with np.load(path) as saved:
        if "name" in saved:
            return file_trial(str(saved["name"]), int(saved["seed"]))
        return trial(saved["points"], int(saved["seed"]))


@app.default
def main(
    *,
    seconds: float = 60.0,
    workers: int | None = None,
    seed: int | None = None,
    out: Path = Path("out/fuzz"),
    repeat: Path | None = None,
) -> int:
    """Fuzz for a while, or repeat what failed.

    Parameters
    ----------
    seconds
        How long.
    workers
        Inputs tried at the same time; as many as cores if left out.
    seed
        Of the inputs; another one each time if left out.
    out
        The folder for inputs that fail.
    repeat
        A file of that folder: run it here, with the traceback.
    """
    if repeat is not None:
        console.print(", ".join(run_again(repeat)))
        return 0
    out.mkdir(parents=True, exist_ok=True)
    seed = int.from_bytes(os.urandom(4), "little") if seed is None else seed
    workers = len(os.sched_getaffinity(0)) if workers is None else workers
    console.print(f"seed {seed}, {workers} at a time, {seconds:g} s")
    tally, lock, cases = Tally(), threading.Lock(), everything(seed)
    until = time.monotonic() + seconds
    threads = [threading.Thread(target=fuzz, args=(cases, lock, until, out, tally)) for _ in range(workers)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    console.print(tally.table())
    console.print("ways: " + ", ".join(f"{way} {count:,}" for way, count in tally.ways.most_common()))
    console.print(f"{tally.inputs.total():,} inputs, {len(tally.failures)} failures")
    return 1 if tally.failures else 0


if __name__ == "__main__":
    sys.exit(app())

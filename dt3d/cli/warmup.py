"""``dt3d warmup``: all that is compiled at first calls, compiled now."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .._numba.cores import available_cores
from .reporting import Reporting, Speaker
from .steps import Steps

if TYPE_CHECKING:
    import subprocess
    from typing import TypeAlias

    Task: TypeAlias = Callable[[], None]

WAIT = 0.05  # seconds between looks at the processes
# the words after ``python -c``: where packages are, and a function of `dt3d._warmup`
PROGRAM = "import sys; sys.path[:] = {path!r}; from dt3d import _warmup; _warmup.{function}()"


@dataclass
class _Running:
    """A process that compiles."""

    name: str
    process: subprocess.Popen[str]
    ended: contextlib.ExitStack


def warmup(*, reporting: Reporting = Reporting()) -> None:  # noqa: B008  frozen
    """Compile all that first calls compile, and keep it on disk: later calls of this machine do not wait.

    Takes a minute or two on two cores, and a second where it was done before. Several processes work side by
    side. JAX's programs, which extrapolation and `dt3d.jax` use, are compiled in every process anyway.

    Parameters
    ----------
    reporting
        What is said of it.
    """
    from .. import _warmup

    speaker = Speaker(reporting)
    begun = time.perf_counter()
    tasks = [_warmup.FIRST, *_warmup.OTHERS]
    with Steps(speaker.bars, [_name(task) for task in tasks], quiet=reporting.quiet) as steps:
        _run([_warmup.FIRST], 1, steps)  # which has a second process itself
        _run(_warmup.OTHERS, available_cores(), steps)
    for name, seconds in steps.seconds.items():
        speaker.show(f"{seconds:6.1f} s  {name}")
    seconds = time.perf_counter() - begun
    speaker.show(f"{seconds:6.1f} s  in all; what was compiled is on disk")
    speaker.result({"seconds": {**steps.seconds, "total": seconds}})


def _name(task: Task) -> str:
    return task.__name__.replace("_", " ")


def _run(tasks: Sequence[Task], processes: int, steps: Steps) -> None:
    """Run tasks in so many processes at a time; what one says when it fails is an OSError."""
    waiting, running = list(tasks), list[_Running]()
    try:
        while waiting or running:
            while waiting and len(running) < processes:
                running.append(_started(waiting.pop(0), steps))
            for one in [one for one in running if one.process.poll() is not None]:
                running.remove(one)
                _, said = one.process.communicate()
                if one.process.returncode:
                    last = (said.strip().splitlines() or ["it ended without a word"])[-1]
                    msg = f"{one.name} could not be compiled: {last}"
                    raise OSError(msg)
                one.ended.close()
            time.sleep(WAIT)
    finally:
        for one in running:
            one.process.kill()
            one.process.communicate()


def _started(task: Task, steps: Steps) -> _Running:
    import subprocess  # loads much, and each command would wait for it

    program = PROGRAM.format(path=sys.path, function=task.__name__)
    stack = contextlib.ExitStack()
    stack.enter_context(steps.step(_name(task)))
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    return _Running(_name(task), process, stack)

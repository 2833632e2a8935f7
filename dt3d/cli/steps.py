"""What a command is doing, and what is left: a bar for each of its steps, on a terminal."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)


class Steps:
    """The steps of a command, one after the other; to be used as a context.

    A step whose end can be told shows how much time is left; others show that they go on.

    Parameters
    ----------
    console : Console
        Where bars are drawn, if it is a terminal; they go when the context ends.
    names : sequence of str
        All steps that will come.
    quiet : bool
        Draw nothing.

    Attributes
    ----------
    seconds : dict of str to float
        Wall time of each step that has ended.
    """

    def __init__(self, console: Console, names: Sequence[str], *, quiet: bool = False) -> None:
        self.seconds: dict[str, float] = {}
        self._bars = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.fields[left]}"),
            TimeRemainingColumn(compact=True, elapsed_when_finished=False),
            console=console,
            transient=True,
            disable=quiet or not console.is_terminal,
        )
        self._tasks = {name: self._bars.add_task(name, start=False, total=1, left="") for name in names}

    def __enter__(self) -> Steps:
        self._bars.start()
        return self

    def __exit__(self, *_: object) -> None:
        if not self._bars.disable:  # where it is, rich before 14.3 prints an empty line
            self._bars.stop()

    @contextmanager
    def step(self, name: str, *, counts: bool = False) -> Iterator[Callable[[int, int], None]]:
        """Do a step within this context.

        Parameters
        ----------
        name : str
            One of those that were announced.
        counts : bool
            Whether its end can be told.

        Returns
        -------
        function
            To be called with how much is done, and how much there is in all.
        """
        task = self._tasks[name]
        begun = time.perf_counter()
        self._bars.start_task(task)
        self._bars.update(task, total=1 if counts else None)

        def done(count: int, total: int) -> None:
            self._bars.update(task, completed=count, total=total, left="left" if count < total else "")

        yield done
        self._bars.update(task, completed=1, total=1, left="")
        self.seconds[name] = time.perf_counter() - begun

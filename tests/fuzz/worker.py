"""A process that runs trials for another one, which can end it when it hangs and sees when it dies."""

from __future__ import annotations

import multiprocessing
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

WARMING = 900.0  # seconds for what is compiled before the first job


def _serve(connection: Connection, function: Callable[..., Any]) -> None:
    while True:
        job = connection.recv()
        if job is None:
            return
        try:
            connection.send(("done", function(*job)))
        except Exception as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            kind = f"{type(error).__name__}: {error}".splitlines()[0]
            connection.send(("failed", f"{kind} ({last.name}, {last.filename.rpartition('/')[2]})"))


class Worker:
    """A process that calls ``function(*job)``, one job at a time.

    Parameters
    ----------
    function : callable
        Of a module, so that a new process can import it.
    patience : float
        Seconds after which a job does not end.
    warming : list of jobs
        Done by each new process before others, with more patience, since they compile.
    """

    def __init__(self, function: Callable[..., Any], patience: float, warming: list[tuple]) -> None:
        self.function = function
        self.patience = patience
        self.warming = warming
        self.process: Any = None

    def _start(self) -> None:
        # a new interpreter: threads and JAX do not survive a fork
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, self.function), daemon=True)
        self.process.start()
        theirs.close()
        for job in self.warming:
            self._ask(job, WARMING)

    def _ask(self, job: tuple, patience: float) -> tuple[str, Any]:
        self.connection.send(job)
        return (
            self.connection.recv()
            if self.connection.poll(patience)
            else ("hangs", f"no end in {patience:g} s")
        )

    def run(self, *job: Any) -> tuple[str, Any]:
        """("done", what the function returned), ("failed", why), ("hangs", ...) or ("dies", ...)."""
        try:
            if self.process is None:
                self._start()
            outcome = self._ask(job, self.patience)
        except (EOFError, BrokenPipeError, ConnectionResetError):
            self.process.join()
            outcome = "dies", f"the process ended with status {self.process.exitcode}"
        if outcome[0] in ("hangs", "dies"):
            self.end()
        return outcome

    def end(self) -> None:
        """End the process, whatever it does."""
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.connection.close()
            self.process = None

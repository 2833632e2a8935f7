"""How a command ends: what becomes one line, what keeps its traceback, and the exit status of each.

====== ====================================================================================
0      done
1      `dt3d verify`: not a Delaunay triangulation; `dt3d experiment all`: one of them failed
2      bad words or input, a file that cannot be read or written, memory that is not there;
       one line says what
70     a fault of dt3d, to be reported (EX_SOFTWARE of sysexits.h)
130    Ctrl-C (128 + SIGINT)
141    the reader of the output has closed it, as `head` does (128 + SIGPIPE)
====== ====================================================================================
"""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Callable, Iterator
from typing import Any, TextIO

from rich.console import Console

from ._errors import InconsistencyError, InternalError

DONE, NOT_DELAUNAY, BAD_INPUT, FAULT, INTERRUPTED, CLOSED = 0, 1, 2, 70, 130, 141
EXPERIMENT_FAILED = 1


class Verdict(SystemExit):
    """The status of a command that has said all there is to say."""

    def __init__(self, status: int) -> None:
        super().__init__(status)
        self.status = status


class Printer(Console):
    """A console that passes its failures to `run`: rich itself would end the process with status 1.

    Nor does it draw stars for the name of a file that has ``:star:`` in it.
    """

    def __init__(self, **options: Any) -> None:  # rich's
        super().__init__(emoji=False, **options)

    def on_broken_pipe(self) -> None:
        """Raise the BrokenPipeError that called this."""
        raise

    def print(self, *objects: object, **options: Any) -> None:  # rich's
        """Print; an OSError of one line where that fails."""
        try:
            super().print(*objects, **options)
        except BrokenPipeError:
            raise
        except OSError as error:
            msg = f"cannot print: {error.strerror or error}"
            raise OSError(msg) from error


def run(command: Callable[[Console], object]) -> int:
    """Run a command, which gets the console for errors; returns its exit status.

    Warnings and what is logged come out as single lines.
    """
    ended: BaseException = Verdict(DONE)
    try:
        with _printable(), _Interrupts() as interrupts:
            errors = Printer(stderr=True, soft_wrap=True, highlight=False)
            try:
                with _lines(errors):
                    command(errors)
            except BaseException as error:
                ended = error
            interrupts.over = True
            if interrupts.seen:  # also where it was lost in a callback, or became another error there
                ended = KeyboardInterrupt()
            return _flush(errors, _end(errors, ended))
    except KeyboardInterrupt:  # another one, in the very moment of ending
        return INTERRUPTED


def one_line(text: object) -> str:
    """The text as a line that any terminal can show: folded, and without control characters."""
    folded = " ".join(filter(None, (line.strip() for line in str(text).splitlines())))
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in folded)


def _end(errors: Console, error: BaseException) -> int:
    """Say how it ended; returns the status."""
    if isinstance(error, Verdict):
        return error.status
    if isinstance(error, KeyboardInterrupt):
        _say(errors, "interrupted")
        return INTERRUPTED
    if isinstance(error, BrokenPipeError):
        return CLOSED
    if isinstance(error, MemoryError) or _is_memory(error):
        _say(errors, f"dt3d: there is not enough memory: {one_line(error) or 'the system gave none'}")
        return BAD_INPUT
    if isinstance(error, (ValueError, OSError, ImportError, InconsistencyError)):
        _say(errors, f"dt3d: {one_line(error) or type(error).__name__}")
        return BAD_INPUT
    if isinstance(error, SystemExit):  # some libraries leave where they should raise
        _say(errors, f"dt3d: a library gave up on the input: {one_line(error.code)}")
        return BAD_INPUT
    if isinstance(error, InternalError):
        _say(errors, f"dt3d: {one_line(error)}")
        return FAULT
    with contextlib.suppress(OSError):
        traceback.print_exception(error)
    _say(errors, "dt3d: this is a fault of dt3d, not of the input; please report it with the lines above")
    return FAULT


def _is_memory(error: BaseException) -> bool:
    """Whether JAX, whose errors are all of one class, found no memory."""
    classes = ("JaxRuntimeError", "XlaRuntimeError")
    return type(error).__name__ in classes and "RESOURCE_EXHAUSTED" in str(error)


def _say(errors: Console, line: str) -> None:
    try:
        errors.print(line, markup=False)
    except (OSError, ValueError):  # there is nobody left to be told
        _silence(sys.stderr)


def _flush(errors: Console, status: int) -> int:
    """Write what is still buffered, here, where it can be reported; Python would do it after the end."""
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except BrokenPipeError:
            _silence(stream)
            status = status or CLOSED
        except (OSError, ValueError) as error:
            _silence(stream)
            if status == DONE:
                _say(errors, f"dt3d: cannot print: {getattr(error, 'strerror', None) or error}")
                status = BAD_INPUT
    return status


def _silence(stream: TextIO) -> None:
    """What is left in the buffer goes nowhere, rather than into a complaint of Python's after the end."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


@contextlib.contextmanager
def _printable() -> Iterator[None]:
    """Names and signs that a terminal's encoding lacks are escaped, and end nothing."""
    streams = [s for s in (sys.stdout, sys.stderr) if hasattr(s, "reconfigure")]
    before = [s.errors for s in streams]
    for stream in streams:
        stream.reconfigure(errors="backslashreplace")
    try:
        yield
    finally:
        for stream, errors in zip(streams, before, strict=True):
            with contextlib.suppress(OSError, ValueError):
                stream.reconfigure(errors=errors)


@contextlib.contextmanager
def _lines(errors: Console) -> Iterator[None]:
    """Warnings, and what is logged, as single lines."""

    class Lines(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            _say(errors, f"dt3d: {one_line(record.getMessage())}")

    def show(message: Warning | str, *_: object, **__: object) -> None:
        _say(errors, f"dt3d: warning: {one_line(message)}")

    log, lines = logging.getLogger("dt3d"), Lines()
    log.addHandler(lines)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = show
            yield
    finally:
        log.removeHandler(lines)


class _Interrupts:
    """Ctrl-C raises KeyboardInterrupt, and is remembered where that is lost; in the end it does nothing."""

    def __init__(self) -> None:
        self.seen = self.over = False
        self.before: Any = None

    def __enter__(self) -> _Interrupts:
        if threading.current_thread() is threading.main_thread():
            before = signal.getsignal(signal.SIGINT)
            if callable(before):  # neither ignored nor set by something else than Python
                self.before = before
                signal.signal(signal.SIGINT, self._come)
        self.unraisable = sys.unraisablehook
        sys.unraisablehook = self._unraisable
        return self

    def __exit__(self, *_: object) -> None:
        sys.unraisablehook = self.unraisable
        if self.before is not None:
            signal.signal(signal.SIGINT, self.before)

    def _come(self, *_: object) -> None:
        self.seen = True
        if not self.over:
            raise KeyboardInterrupt

    def _unraisable(self, what: sys.UnraisableHookArgs) -> None:
        if not isinstance(what.exc_value, (KeyboardInterrupt, BrokenPipeError)):
            self.unraisable(what)

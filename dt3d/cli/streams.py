"""``-``: points from standard input, and meshes to standard output.

Readers and writers know a format by the extension of a file. So what comes is put into a temporary file
first, and what goes is taken from one when it is whole.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

STREAM = Path("-")
INPUT, OUTPUT = Path("standard input"), Path("standard output")


@dataclass(frozen=True)
class Formats:
    """The extensions, such as ``.csv``, of what comes and goes through streams; empty for files."""

    source: str = ""
    output: str = ""


def formats_of(given: str | None, source: Path, output: Path | None = None) -> Formats:
    """The formats of the streams among a source and an output.

    Parameters
    ----------
    given : str, optional
        The value of ``--format``: an extension with or without its dot; two, with a comma between, where both
        are streams.
    source, output : Path
        `STREAM` or files.

    Raises
    ------
    ValueError
        If there are more or fewer formats than streams.
    """
    streams = [path == STREAM for path in (source, output)]
    found = [] if given is None else [f".{part.strip().lstrip('.')}" for part in given.split(",")]
    if len(found) != sum(streams) or "." in found:
        if not any(streams):
            msg = "--format is for - (standard input or output); files have their extensions"
        elif all(streams):
            msg = f"--format must be two formats here, as in --format csv,vtu; got {given or 'none'}"
        else:
            what = "what comes by standard input" if streams[0] else "what goes to standard output"
            msg = f"--format must be the format of {what}, as in --format {'csv' if streams[0] else 'vtu'}; "
            msg += f"got {given or 'none'}"
        raise ValueError(msg)
    parts = iter(found)
    return Formats(*(next(parts) if is_stream else "" for is_stream in streams))


@contextmanager
def incoming(source: Path, extension: str) -> Iterator[tuple[Path, Path]]:
    """The file to be read, or a copy of the stream for this context; and its name in messages."""
    if source != STREAM:
        yield source, source
        return
    with tempfile.TemporaryDirectory(prefix="dt3d-") as folder:
        copy = Path(folder) / f"input{extension}"
        with copy.open("wb") as file:
            shutil.copyfileobj(sys.stdin.buffer, file)
        yield copy, INPUT


@contextmanager
def outgoing(output: Path, extension: str) -> Iterator[tuple[Path, Path]]:
    """The file to be written, and its name; what is there when the context ends goes to the stream."""
    if output != STREAM:
        yield output, output
        return
    if sys.stdout.isatty():
        msg = (
            "a mesh is not for a terminal: name a file, or pass standard output on, as in ... -o - | program"
        )
        raise ValueError(msg)
    with tempfile.TemporaryDirectory(prefix="dt3d-") as folder:
        path = Path(folder) / f"output{extension}"
        yield path, OUTPUT
        with path.open("rb") as file:
            shutil.copyfileobj(file, sys.stdout.buffer)

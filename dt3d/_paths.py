"""What must be true of a path before it is read or written."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from scanvec._writing import check_writable, written_aside

__all__ = ["by_extension", "check_apart", "check_extension", "check_file", "check_writable", "written_aside"]

F = TypeVar("F", bound=Callable[..., object])


def check_file(path: Path) -> Path:
    """The path, if there is such a file; otherwise a FileNotFoundError."""
    if not path.exists():
        msg = f"there is no file {path}"
        raise FileNotFoundError(msg)
    return path


def check_apart(written: Path, other: Path, way_out: str = "name another file") -> None:
    """A ValueError if what is to be written is another file of the same command, by links too."""
    with suppress(OSError):  # there is no such file yet
        if written.samefile(other):
            msg = f"{written} and {other} are one file, which would be replaced; {way_out}"
            raise ValueError(msg)
    if os.path.realpath(written) == os.path.realpath(other):
        msg = f"{written} and {other} would be one file; {way_out}"
        raise ValueError(msg)


def check_target(path: str | Path, table: dict[str, F], verb: str) -> Path:
    """The path, if the table has its extension and it can be written; a ValueError or OSError if not."""
    path = Path(path)
    by_extension(path, table, verb)
    check_writable(path)
    return path


def by_extension(path: Path, table: dict[str, F], verb: str) -> F:
    """The table's entry for the extension, in any case; otherwise a ValueError that lists the known ones."""
    check_extension(path, sorted(table), verb)
    return table[path.suffix.lower()]


def check_extension(path: Path, known: Iterable[str], verb: str) -> None:
    """A ValueError that lists the known extensions, unless the path has one of them, in any case."""
    known = tuple(known)
    if path.suffix.lower() not in known:
        msg = f"cannot {verb} {path}: unknown extension {path.suffix!r}; known are {', '.join(known)}"
        raise ValueError(msg)

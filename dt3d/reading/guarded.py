"""The one place where whatever goes wrong while a file is read becomes one line that names the file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

LONGEST_REASON = 400
"""Characters of a library's own words in a message; some print the whole file."""


def guarded(reader: Callable[[Path], T], path: Path, called: Path | None = None) -> T:
    """What the reader makes of the file; any error of any library comes as one line that names the file.

    Parameters
    ----------
    reader : function of a Path
        Its own messages start with the path; those of libraries need not.
    path : Path
        What the reader is given.
    called : Path, optional
        What messages call the file, where ``path`` is a copy of it.

    Raises
    ------
    OSError
        If the file cannot be opened, or memory does not hold it.
    ValueError
        For everything else that is wrong with it, an exit from within a library included.
    ImportError
        If the package that reads this kind of file is not installed.
    """
    called = path if called is None else called
    try:
        return reader(path)
    except (ImportError, KeyboardInterrupt):
        raise
    except MemoryError as error:
        msg = _sentence(error, path, called, f"{called} needs more memory than there is")
        raise OSError(msg) from error
    except OSError as error:
        msg = _sentence(error, path, called, f"{called} could not be read")
        raise type(error)(msg) from error
    except BaseException as error:
        # libraries of formats raise struct.error, IndexError, zlib.error ..., and one of them calls sys.exit
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        msg = _sentence(error, path, called, f"{called} could not be read: {kind}".rstrip(": "))
        raise ValueError(msg) from error


def one_line(text: str) -> str:
    """The text without the line breaks and control characters that garbled files bring into messages."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _sentence(error: BaseException, path: Path, called: Path, otherwise: str) -> str:
    """The error's own words if they name the file, else ``otherwise`` and its words."""
    words = str(error).replace(str(path), str(called))
    if str(called) not in words:
        words = f"{otherwise}: {words}" if words else otherwise
    words = one_line(words)
    # the path may be as long as it likes
    most = len(str(called)) + LONGEST_REASON
    return words if len(words) <= most else f"{words[:most]} ..."

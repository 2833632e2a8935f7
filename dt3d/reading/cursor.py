"""Walking through a file of words and numbers that keeps its promises, or is refused where it breaks them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np

WORD = re.compile(rb"\s*(\S+)")


class Cursor:
    """A place in the bytes of a file.

    Parameters
    ----------
    path : Path
        For messages.
    data : bytes
        The whole file, or the part that is to be walked through.
    order : str, optional
        "<" or ">" if arrays are binary, of this byte order. Arrays are text if left out.
    """

    def __init__(self, path: Path, data: bytes, order: Literal["<", ">"] | None = None) -> None:
        self.path, self.data = path, data
        self.order: Literal["<", ">"] | None = order
        self.at = 0

    def word(self, what: str) -> str:
        """The next word, which ``what`` describes in the message if there is none."""
        found = self.look()
        if found is None:
            msg = f"{self.path} is cut off: it ends where {what} should be"
            raise ValueError(msg)
        self.at = found.end()
        return found[1].decode("utf-8", "replace")

    def look(self) -> re.Match[bytes] | None:
        """The next word without going past it; None at the end."""
        return WORD.match(self.data, self.at)

    def line(self) -> str:
        """What is left of this line."""
        end = self.data.find(b"\n", self.at)
        text = self.data[self.at : end if end >= 0 else None]
        self.at = end + 1 if end >= 0 else len(self.data)
        return text.decode("utf-8", "replace").strip()

    def count(self, what: str, *, listed: bool = True) -> int:
        """The next word as a number of things; each of what is listed takes a byte of the file at least."""
        word = self.word(what)
        if not word.isdecimal() or not word.isascii():
            msg = f"{self.path}: expected {what}, found {word[:40]!r}"
            raise ValueError(msg)
        if listed and int(word[:4000]) > len(self.data):
            msg = f"{self.path} is damaged: {what} is {word[:40]}, more than the file has bytes"
            raise ValueError(msg)
        return int(word[:4000])

    def array(self, count: int, dtype: np.dtype | str, what: str) -> np.ndarray:
        """The next ``count`` numbers, in text or binary as the file is."""
        if self.order is None:
            return self.text(count, np.dtype(dtype).kind != "f", what)
        return self.binary(count, np.dtype(dtype), what)

    def binary(self, count: int, dtype: np.dtype, what: str) -> np.ndarray:
        """The numbers that start here, in the file's byte order."""
        end = self.at + count * dtype.itemsize
        if end > len(self.data):
            msg = (
                f"{self.path} is cut off: {what} take {count * dtype.itemsize} bytes, "
                f"and {len(self.data) - self.at} are left"
            )
            raise ValueError(msg)
        values = np.frombuffer(self.data, dtype.newbyteorder(self.order or "="), count, self.at)
        self.at = end
        return values

    def text(self, count: int, whole: bool, what: str) -> np.ndarray:
        """The next words as int64, or as float64 whatever the file says that their precision is."""
        if count > len(self.data) - self.at:
            msg = f"{self.path} is cut off: {what} should be {count} numbers, which the rest cannot hold"
            raise ValueError(msg)
        words = self.data[self.at :].split(None, count)
        if len(words) > count:
            self.at = len(self.data) - len(words.pop())
        else:
            self.at = len(self.data)
        if len(words) < count:
            msg = f"{self.path} is cut off: {what} should be {count} numbers, and {len(words)} are there"
            raise ValueError(msg)
        return numbers(words, whole, f"{self.path}: {what}")


def numbers(words: Sequence[bytes], whole: bool, what: str) -> np.ndarray:
    """Words as int64 or float64, which ``what`` describes in the message if one is no number."""
    kind = int if whole else float
    try:
        # Python takes 1_000 for a number, and no format does
        if not any(b"_" in word for word in words):
            array = np.array([kind(word) for word in words], np.int64 if whole else np.float64)
            if not whole and np.isinf(array).any():
                _check_infinity(words, array, what)
            return array
    except OverflowError:
        pass
    except ValueError as error:
        if str(error).startswith(what):
            raise
    wrong = next(word for word in words if not _is_number(word, kind))
    msg = f"{what} have {wrong[:40].decode('utf-8', 'replace')!r}, which is no {'whole ' * whole}number"
    raise ValueError(msg)


def _check_infinity(words: Sequence[bytes], array: np.ndarray, what: str) -> None:
    """Raise a ValueError for a number that is too great for float64; infinity itself may be written."""
    for k in np.flatnonzero(np.isinf(array)).tolist():
        if b"n" not in words[k].lower():
            msg = f"{what} have {words[k][:40].decode()}, which is too great for float64 (at most 1.8e308)"
            raise ValueError(msg)


def _is_number(word: bytes, kind: type) -> bool:
    try:
        np.int64(kind(word)) if kind is int else kind(word)
    except (ValueError, OverflowError):
        return False
    return b"_" not in word

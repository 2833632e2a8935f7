"""The lines of a text file with their numbers in it, whatever encoding and line ends it has."""

from __future__ import annotations

import codecs
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BYTE_ORDER_MARKS = [
    # UTF-32's little-endian mark starts with UTF-16's, so it is tried first
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
    (codecs.BOM_UTF8, "utf-8-sig"),
]
COMMENT_MARKS = ("#", "//", "%", "!")
"""What starts a line of comment in tables of numbers: Python and Gnuplot, CloudCompare, MATLAB, Fortran."""


@dataclass(frozen=True)
class Lines:
    """Some lines of a file, and where they stand in it."""

    path: Path
    text: list[str]
    numbers: Sequence[int]  # of the lines in the file; the first is 1

    def __len__(self) -> int:
        """How many lines."""
        return len(self.text)

    def __getitem__(self, part: slice) -> Lines:
        """Some of the lines, with their numbers in the file."""
        return Lines(self.path, self.text[part], self.numbers[part])

    def error(self, k: int, sentence: str, column: int | None = None) -> ValueError:
        """A ValueError that says in which line of the file, and in which column, counted from 1."""
        place = "" if column is None else f", column {column}"
        return ValueError(f"{self.path}, line {self.numbers[k]}{place}: {sentence}")

    def with_text(self, keep: np.ndarray | list[int]) -> Lines:
        """The lines of these indices."""
        return Lines(self.path, [self.text[k] for k in keep], [self.numbers[k] for k in keep])

    def replaced(self, text: list[str]) -> Lines:
        """Other text in the same places."""
        return Lines(self.path, text, self.numbers)


def read_text(path: Path) -> str:
    """The text of a file, in which every line ends with LF.

    UTF-8, with or without a byte-order mark, and UTF-16 and UTF-32 with one. Bytes that are not UTF-8 become
    replacement characters, which may stand in comments and names, and are errors in numbers. Lines end with
    LF, CR LF or CR.

    Raises
    ------
    ValueError
        For NUL characters, which no text has, and for UTF-16 that is cut off.
    """
    data = path.read_bytes()
    encoding = next((name for mark, name in BYTE_ORDER_MARKS if data.startswith(mark)), "utf-8")
    try:
        text = data.decode(encoding, errors="replace" if encoding.startswith("utf-8") else "strict")
    except UnicodeDecodeError as error:
        msg = f"{path} starts as {encoding.upper()} but is not: {error.reason} at byte {error.start}"
        raise ValueError(msg) from None
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        msg = f"{path}, line {line}: a NUL character, which no text has; it is damaged, binary, or UTF-16"
        raise ValueError(msg)
    return text


def read_lines(path: Path) -> Lines:
    """All lines of a file, blank ones too; raises what `read_text` raises."""
    lines = read_text(path).split("\n")
    if not lines[-1]:
        lines.pop()  # what follows the last line end
    return Lines(path, lines, range(1, len(lines) + 1))


def content(lines: Lines, marks: tuple[str, ...] = COMMENT_MARKS) -> Lines:
    """The lines that are neither blank nor comments; what follows a blank and ``#`` on a line goes too."""
    kept = [k for k, line in enumerate(lines.text) if (bare := line.strip()) and not bare.startswith(marks)]
    rows = lines if len(kept) == len(lines) else lines.with_text(kept)
    if "#" in marks and any("#" in line for line in rows.text):
        rows = rows.replaced([_without_remark(line) for line in rows.text])
    return rows


def _without_remark(line: str) -> str:
    # only after a blank, and not in quotes: 1.#IND is what Windows writes for NaN, and must not become 1
    found = re.search(r"\s#", line)
    return line[: found.start()] if found and '"' not in line[: found.start()] else line


def shown(text: str) -> str:
    """A part of the file as a message quotes it: at most some 40 characters."""
    return repr(text if len(text) <= 40 else text[:40] + "...")


def shown_names(names: list[str]) -> str:
    """The names of columns as a message lists them: a dozen at most."""
    short = [name if len(name) <= 30 else name[:30] + "..." for name in names[:12]]
    return ", ".join(short) + (f", ... ({len(names)} in all)" if len(names) > 12 else "")

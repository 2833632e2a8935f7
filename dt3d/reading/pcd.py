"""The points of PCD files, as the Point Cloud Library writes them: text, binary, and compressed by LZF.

Source: PCL's documentation, "The PCD (Point Cloud Data) file format".
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .columns import stack_columns
from .cursor import Cursor
from .point_data import PointData

TYPES = {"F": "f", "I": "i", "U": "u"}

FORMS = ("ascii", "binary", "binary_compressed")

MOST_LZF = 264
"""A compressed run of three bytes stands for at most so many."""


def read_pcd(path: Path, keep: PointData | None = None) -> np.ndarray:
    """x, y and z of all points, float64 (n, 3); points that a sensor missed are NaN, as in the file.

    ``keep`` gets the other fields; PCL's packed colours ``rgb`` stay the one number that they are.

    Raises
    ------
    ValueError
        If the header is not understood, or does not go with what follows it.
    """
    cursor = Cursor(path, path.read_bytes())
    header: dict[str, list[str]] = {}
    while "DATA" not in header:
        if cursor.look() is None:
            msg = f"{path} is cut off: its header has no line DATA" if cursor.data else f"{path} is empty"
            raise ValueError(msg)
        words = cursor.line().split()
        if words and not words[0].startswith("#"):
            header[words[0].upper()] = words[1:]
    names, sizes, types, counts, n = _layout(path, cursor, header)
    form = " ".join(header["DATA"]).lower()
    axes = [k for axis in "xyz" for k, name in enumerate(names) if name.lower() == axis]
    if len(axes) < 2 or names[axes[1]].lower() != "y" or any(counts[k] != 1 for k in axes):
        msg = f"{path}: expected fields x, y and z, found {', '.join(names)[:80]}"
        raise ValueError(msg)
    others = [k for k in range(len(names)) if k not in axes and names[k] != "_"]  # which fills a gap
    if keep is None:
        others, keep = [], PointData()
    if form == "ascii":
        starts = np.cumsum([0, *counts])
        rows = cursor.text(n * int(starts[-1]), False, "points").reshape(n, -1)
        _check_end(cursor)
        for k in others:
            keep.add(names[k], rows[:, starts[k] : starts[k + 1]], f"{TYPES[types[k]]}{sizes[k]}")
        return rows[:, starts[axes]]
    kinds = [np.dtype(f"<{TYPES[kind]}{size}") for kind, size in zip(types, sizes, strict=True)]
    if form == "binary":
        fields = [(str(k), kind, (count,)) for k, (kind, count) in enumerate(zip(kinds, counts, strict=True))]
        table = cursor.binary(n, np.dtype(fields), "points")
        every = [table[str(k)] for k in range(len(names))]
    else:
        width = sum(kind.itemsize * count for kind, count in zip(kinds, counts, strict=True))
        plain = Cursor(path, _unpacked(path, cursor, n * width), "<")
        # compressed files have all x first, then all y, and so on
        every = [plain.binary(n * count, kind, "points") for kind, count in zip(kinds, counts, strict=True)]
        every = [values.reshape(n, -1) for values in every]
    _check_end(cursor)
    for k in others:
        keep.add(names[k], every[k])
    return stack_columns(path, [(names[k], every[k][:, 0]) for k in axes])


def _layout(
    path: Path, cursor: Cursor, header: dict[str, list[str]]
) -> tuple[list[str], list[int], list[str], list[int], int]:
    """The fields' names, sizes, types and counts, and the number of points."""
    names = header.get("FIELDS", header.get("COLUMNS", []))
    types = header.get("TYPE", [])
    try:
        sizes = [int(word) for word in header.get("SIZE", [])]
        counts = [int(word) for word in header.get("COUNT", ["1"] * len(names))]
        width, height = (int(header[name][0]) for name in ("WIDTH", "HEIGHT"))
        n = int(header["POINTS"][0]) if "POINTS" in header else width * height
    except (KeyError, ValueError, IndexError) as error:
        msg = f"{path}: the header lacks a number ({error})"
        raise ValueError(msg) from None
    fits = len(names) == len(sizes) == len(types) == len(counts)
    known = all((kind in "IU" and size in (1, 2, 4, 8)) or (kind == "F" and size in (4, 8))
                for kind, size in zip(types, sizes, strict=False))  # fmt: skip
    form = " ".join(header["DATA"]).lower()
    if not (names and fits and known and min(counts) > 0 and form in FORMS):
        keys = ("SIZE", "TYPE", "COUNT", "DATA")
        parts = "; ".join(f"{key} {' '.join(header.get(key, []))}" for key in keys)
        msg = f"{path}: the header is not understood: {len(names)} FIELDS; {parts[:200]}"
        raise ValueError(msg)
    if n != width * height or min(n, width, height) < 0:
        msg = f"{path} is damaged: WIDTH {width} times HEIGHT {height} is not POINTS {n}"
        raise ValueError(msg)
    most = len(cursor.data) * (MOST_LZF if form == "binary_compressed" else 1)
    if n * sum(counts) > most or max(counts) > most:
        msg = f"{path} is damaged: {n} points are promised, which its {len(cursor.data)} bytes cannot hold"
        raise ValueError(msg)
    if n == 0:
        msg = f"{path} holds no points"
        raise ValueError(msg)
    return names, sizes, types, counts, n


def _check_end(cursor: Cursor) -> None:
    if left := len(cursor.data[cursor.at :].strip()):
        msg = f"{cursor.path} is damaged: {left} bytes follow the points that its header promises"
        raise ValueError(msg)


def _unpacked(path: Path, cursor: Cursor, expected: int) -> bytes:
    """The bytes behind a compressed file's two sizes; they must make ``expected`` bytes."""
    packed, size = cursor.binary(2, np.dtype("<u4"), "the sizes of compressed data").tolist()
    data = cursor.binary(packed, np.dtype("u1"), "compressed data").tobytes()
    if size != expected:
        msg = f"{path} is damaged: its points take {expected} bytes, and it says {size}"
        raise ValueError(msg)
    plain = lzf_decompress(data, size)
    if len(plain) != size:
        msg = f"{path} is damaged: its compressed data make {len(plain)} bytes, not {size}"
        raise ValueError(msg)
    return plain


def lzf_decompress(data: bytes, most: int) -> bytes:
    """What LibLZF has compressed, as far as it goes: no more than ``most`` bytes and a run.

    A control byte below 32 announces so many literal bytes and one; any other a copy of what came before:
    three bits of length, five and eight of distance.

    Raises
    ------
    ValueError
        If the data end inside a run, or a copy reaches before the beginning.
    """
    out, at = bytearray(), 0
    while at < len(data) and len(out) <= most:
        control = data[at]
        at += 1
        if control < 32:
            run = data[at : at + control + 1]
            at += control + 1
            if len(run) != control + 1:
                msg = "compressed data are cut off"
                raise ValueError(msg)
            out += run
            continue
        length, distance = control >> 5, (control & 31) << 8
        more = 2 if length == 7 else 1
        if at + more > len(data):
            msg = "compressed data are cut off"
            raise ValueError(msg)
        if length == 7:
            length += data[at]
        distance += data[at + more - 1] + 1
        at += more
        start, length = len(out) - distance, length + 2
        if start < 0:
            msg = "compressed data copy from before their beginning"
            raise ValueError(msg)
        # a copy may overlap itself, which repeats
        piece = bytes(out[start : start + length])
        out += (piece * -(-length // len(piece)))[:length]
    return bytes(out)

"""The vertices of PLY files, in text and in both byte orders, with other elements and lists around them.

Source: Turk, "The PLY Polygon File Format" (1994). meshio does not end where a header is cut off, and knows
neither other elements (PCL writes ``camera``) nor lists of vertices; plyfile takes the memory that a header
asks for before it looks, is slow in text, and is under the GPL.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .columns import stack_columns
from .cursor import numbers
from .point_data import PointData

SCALARS = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8",
}  # fmt: skip

ORDERS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass
class Element:
    """An element of the header: ``count`` rows of scalars and lists.

    ``properties`` are triples of a name, the type of a scalar or of a list's items, and that of a list's
    length, which is "" for a scalar. Types are NumPy's, such as "f4".
    """

    name: str
    count: int
    properties: list[tuple[str, str, str]] = field(default_factory=list)


def read_ply(path: Path, keep: PointData | None = None) -> np.ndarray:
    """The x, y and z of all vertices, float64 (n, 3), or (n, 2) where there is no z.

    Text is read in double precision whatever the header says. ``keep`` gets the other scalars of vertices.

    Raises
    ------
    ValueError
        If the header is not understood, or the rows that it promises are not what follows it, to the end.
    """
    data = path.read_bytes()
    form, elements, at = _header(path, data)
    order = ORDERS[form]
    body: _Text | _Binary = _Text(path, data[at:]) if order is None else _Binary(path, data, at, order)
    found = None
    for element in elements:
        columns = _read(body, element)
        if element.name == "vertex":
            found, vertex = columns, element
    body.check_end()
    if found is None:
        msg = f"{path} has no element 'vertex', but {', '.join(e.name for e in elements)[:80] or 'none'}"
        raise ValueError(msg)
    axes = [name for axis in "xyz" for name in found if name.lower() == axis]
    if "".join(axes).lower() not in ("xy", "xyz"):
        msg = f"{path}: vertices should have x, y and z, found {', '.join(found)[:80] or 'none'}"
        raise ValueError(msg)
    points = stack_columns(path, [(name, found[name]) for name in axes])
    if not len(points):
        msg = f"{path} has no vertices"
        raise ValueError(msg)
    if keep is not None:
        for name, kind, is_list in vertex.properties:
            if is_list:
                keep.leave_out(name, "it is a list")
            elif name not in axes:
                keep.add(name, found[name], None if order else kind)
    return points


def _header(path: Path, data: bytes) -> tuple[str, list[Element], int]:
    """The format, the elements, and where the rows start."""
    if data[:3] != b"ply" or data[3:4] not in (b"\n", b"\r"):
        msg = f"{path} is no PLY file: it should start with a line 'ply'" if data else f"{path} is empty"
        raise ValueError(msg)
    ends = b"\r\n" if data[3:5] == b"\r\n" else data[3:4]
    form, elements, at, number = "", [], 3 + len(ends), 1
    while True:
        end = data.find(ends, at)
        if end < 0 and data[at:].strip() != b"end_header":
            msg = f"{path} is cut off inside its header"
            raise ValueError(msg)
        words = data[at : end if end >= 0 else None].decode("utf-8", "replace").split()
        at, number = (end + len(ends) if end >= 0 else len(data)), number + 1
        match words:
            case ["end_header"]:
                break
            case [] | ["comment" | "obj_info", *_]:
                continue
            case ["format", ("ascii" | "binary_little_endian" | "binary_big_endian") as form, "1.0"]:
                continue
            case ["element", name, count] if count.isdecimal() and count.isascii():
                if len(count) > 18 or int(count) > len(data):
                    msg = f"{path} is damaged: {count[:40]} rows of {name[:40]!r} in {len(data)} bytes"
                    raise ValueError(msg)
                elements.append(Element(name, int(count)))
            case ["property", kind, name] if kind in SCALARS and elements:
                elements[-1].properties.append((name, SCALARS[kind], ""))
            case ["property", "list", length, kind, name] if elements and {length, kind} <= SCALARS.keys():
                elements[-1].properties.append((name, SCALARS[kind], SCALARS[length]))
            case _:
                msg = f"{path}, line {number}: {' '.join(words)[:60]!r} is not understood in a PLY header"
                raise ValueError(msg)
    if not form:
        msg = f"{path}: the header has no line 'format ascii 1.0', or binary_little_endian, binary_big_endian"
        raise ValueError(msg)
    for element in elements:
        names = [name for name, _, _ in element.properties]
        if len(set(names)) != len(names):
            msg = f"{path}: element {element.name[:40]!r} has a property twice"
            raise ValueError(msg)
    return form, elements, at


class _Text:
    """The words after a header in text."""

    def __init__(self, path: Path, data: bytes) -> None:
        self.path, self.words, self.at = path, data.split(), 0

    def lengths(self, element: Element) -> list[int]:
        """The lengths of the lists of the next row; 0 for scalars."""
        at, lengths = self.at, []
        for _, _, length in element.properties:
            lengths.append(_length(self.path, element, self.words[at : at + 1]) if length else 0)
            at += 1 + lengths[-1]
        return lengths

    def take(self, element: Element, lengths: list[int], count: int) -> dict[str, np.ndarray] | None:
        """The scalars of so many rows, if all have lists of these lengths; otherwise None."""
        width = len(lengths) + sum(lengths)
        block = self.words[self.at : self.at + width * count]
        if len(block) < width * count:
            if not any(length for _, _, length in element.properties) or count == 1:
                raise _cut_off(self.path, element)
            return None
        columns, at = {}, 0
        for (name, kind, is_list), length in zip(element.properties, lengths, strict=True):
            if is_list and any(_length(self.path, element, [word]) != length for word in block[at::width]):
                return None
            if not is_list and element.name == "vertex":
                what = f"{self.path}: values {name!r} of vertices"
                columns[name] = numbers(block[at::width], kind[0] != "f", what)
            at += 1 + length
        self.at += width * count
        return columns

    def skip(self, element: Element) -> None:
        """Go past the next row."""
        for _, _, is_list in element.properties:
            length = _length(self.path, element, self.words[self.at : self.at + 1]) if is_list else 0
            self.at += 1 + length
        if self.at > len(self.words):
            raise _cut_off(self.path, element)

    def check_end(self) -> None:
        if left := len(self.words) - self.at:
            msg = f"{self.path} is damaged: {left} words follow the rows that its header promises"
            raise ValueError(msg)


class _Binary:
    """The bytes after a header."""

    def __init__(self, path: Path, data: bytes, at: int, order: str) -> None:
        self.path, self.data, self.at, self.order = path, data, at, order

    def lengths(self, element: Element) -> list[int]:
        """The lengths of the lists of the next row; 0 for scalars."""
        at, lengths = self.at, []
        for _, kind, length in element.properties:
            size = np.dtype(kind).itemsize
            if length:
                dtype = np.dtype(self.order + length)
                head = np.frombuffer(self.data[at : at + dtype.itemsize].ljust(dtype.itemsize, b"\0"), dtype)
                lengths.append(_length(self.path, element, head.tolist()))
                at += dtype.itemsize + lengths[-1] * size
            else:
                lengths.append(0)
                at += size
        return lengths

    def take(self, element: Element, lengths: list[int], count: int) -> dict[str, np.ndarray] | None:
        """The scalars of so many rows, if all have lists of these lengths; otherwise None."""
        fields: list[tuple[object, ...]] = []
        for k, ((_, kind, is_list), length) in enumerate(zip(element.properties, lengths, strict=True)):
            if is_list:
                fields.append((f"{k} length", self.order + is_list))
                fields.append((f"{k}", self.order + kind, (length,)))
            else:
                fields.append((f"{k}", self.order + kind))
        if sum(lengths) > len(self.data):
            raise _cut_off(self.path, element)
        row = np.dtype(fields)
        if self.at + row.itemsize * count > len(self.data):
            if not any(is_list for _, _, is_list in element.properties) or count == 1:
                raise _cut_off(self.path, element)
            return None
        rows = np.frombuffer(self.data, row, count, self.at) if row.itemsize else np.empty(count, row)
        for k, ((_, _, is_list), length) in enumerate(zip(element.properties, lengths, strict=True)):
            if is_list and (rows[f"{k} length"] != length).any():
                return None
        self.at += row.itemsize * count
        scalars = [(k, name) for k, (name, _, is_list) in enumerate(element.properties) if not is_list]
        return {name: rows[f"{k}"] for k, name in scalars}

    def skip(self, element: Element) -> None:
        """Go past the next row."""
        for _, kind, is_list in element.properties:
            size = int(kind[1])
            if is_list:
                head = self.data[self.at : self.at + int(is_list[1])]
                if is_list[0] == "f" or len(head) < int(is_list[1]):
                    raise _cut_off(self.path, element)
                order: Any = "little" if self.order == "<" else "big"
                length = int.from_bytes(head, order, signed=is_list[0] == "i")
                size = len(head) + size * _length(self.path, element, [length])
            self.at += size
        if self.at > len(self.data):
            raise _cut_off(self.path, element)

    def check_end(self) -> None:
        if left := self.data[self.at :].strip():
            msg = f"{self.path} is damaged: {len(left)} bytes follow the rows that its header promises"
            raise ValueError(msg)


def _read(body: _Text | _Binary, element: Element) -> dict[str, np.ndarray]:
    """The scalars of an element, by name; all rows at once if their lists are of one length, as most are."""
    if not element.count:
        return {name: np.empty(0) for name, _, is_list in element.properties if not is_list}
    columns = body.take(element, body.lengths(element), element.count)
    if columns is not None:
        return columns
    if element.name != "vertex":
        for _ in range(element.count):
            body.skip(element)
        return {}
    rows = [body.take(element, body.lengths(element), 1) or {} for _ in range(element.count)]
    return {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}


def _length(path: Path, element: Element, found: Sequence[bytes | int]) -> int:
    """A list's length, from the word or number in ``found``."""
    try:
        length = int(found[0])
        if 0 <= length == float(found[0]):
            return length
    except IndexError:
        raise _cut_off(path, element) from None
    except (ValueError, OverflowError):
        pass
    word = found[0].decode("utf-8", "replace") if isinstance(found[0], bytes) else str(found[0])
    msg = f"{path} is damaged: {word[:40]!r} is no length of a list of {element.name[:40]!r}"
    raise ValueError(msg)


def _cut_off(path: Path, element: Element) -> ValueError:
    rows = f"{element.count} rows of {element.name[:40]!r}"
    return ValueError(f"{path} is cut off: there are fewer than {rows}")

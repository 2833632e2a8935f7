"""The arrays of VTK's XML files: in text, base64 or raw bytes, inline or appended, compressed or not."""

from __future__ import annotations

import base64
import binascii
import lzma
import xml.etree.ElementTree as ET
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import numpy as np

from .._memory import available_memory, gigabytes
from .._optional import optional
from .cursor import numbers

TYPES = {
    **{f"Int{bits}": f"i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"UInt{bits}": f"u{bits // 8}" for bits in (8, 16, 32, 64)},
    "Float32": "f4",
    "Float64": "f8",
}

COMPRESSORS: dict[str, Callable[[], Any]] = {
    "vtkZLibDataCompressor": zlib.decompressobj,
    "vtkLZMADataCompressor": lzma.LZMADecompressor,
}


class Arrays:
    """Reads the arrays of one file; each must be as long as the reader of the file expects it to be.

    Parameters
    ----------
    path : Path
        For messages.
    root : Element
        VTKFile, which tells the byte order, the type of sizes and the compression.
    appended : memoryview
        What follows the underscore of AppendedData.
    appended_base64 : bool
        Whether these are letters of base64, and not raw.
    """

    def __init__(self, path: Path, root: ET.Element, appended: memoryview, appended_base64: bool) -> None:
        self.path, self.appended, self.appended_base64 = path, appended, appended_base64
        self.order: Literal["<", ">"] = ">" if root.get("byte_order") == "BigEndian" else "<"
        self.size = np.dtype("u8" if root.get("header_type") == "UInt64" else "u4").newbyteorder(self.order)
        self.compressor = root.get("compressor")

    def read(self, array: ET.Element, count: int) -> np.ndarray:
        """The numbers of a DataArray.

        Parameters
        ----------
        array : Element
            The DataArray.
        count : int
            How many numbers it must hold.

        Returns
        -------
        (count,)
            In the file's type; of text, int64 or float64.

        Raises
        ------
        ValueError
            If it holds another number of them, or letters or bytes that do not belong there.
        """
        name = array.get("Name", "")[:40]
        kind = TYPES.get(array.get("type", ""))
        if kind is None or count < 0:
            msg = f"{self.path}: array {name!r} of {array.get('type')!r} is not read as {count} numbers"
            raise ValueError(msg)
        dtype = np.dtype(kind).newbyteorder(self.order)
        if count * dtype.itemsize > (room := available_memory()):
            need = gigabytes(count * dtype.itemsize)
            msg = f"{self.path}: array {name!r} needs {need} of memory; {gigabytes(room)} are available"
            raise ValueError(msg)
        form = array.get("format", "ascii")
        try:
            if form == "ascii":
                return self._text(array.text or "", count, kind)
            data = self._inline(array) if form == "binary" else self._appended(array)
            return np.frombuffer(self._unpacked(data, count * dtype.itemsize), dtype, count)
        except (ValueError, binascii.Error, zlib.error, lzma.LZMAError) as error:
            msg = f"{self.path}: array {name!r} is damaged: {error}"
            raise ValueError(msg) from error

    @staticmethod
    def _text(text: str, count: int, kind: str) -> np.ndarray:
        words = text.split()
        if len(words) != count:
            msg = f"{len(words)} numbers instead of {count}"
            raise ValueError(msg)
        return numbers([word.encode() for word in words], kind[0] != "f", "its values")

    def _inline(self, array: ET.Element) -> _Bytes:
        return _Bytes("".join((array.text or "").split()).encode(), letters=True, whole=True)

    def _appended(self, array: ET.Element) -> _Bytes:
        offset = array.get("offset", "")
        if array.get("format") != "appended" or not offset.isdecimal() or len(offset) > 18:
            msg = f"format {array.get('format')!r} with offset {offset[:40]!r}"
            raise ValueError(msg)
        return _Bytes(self.appended[int(offset) :], letters=self.appended_base64, whole=False)

    def _unpacked(self, data: _Bytes, expected: int) -> bytes:
        """The bytes of an array: a header of sizes, then the data in one part or in compressed blocks."""
        if self.compressor is None:
            (size,) = self._sizes(data.peek(self.size.itemsize))
            if size != expected:
                msg = f"it says that it has {size} bytes, and {expected} are expected"
                raise ValueError(msg)
            return data.take_after(self.size.itemsize, expected)
        blocks, full, last = self._sizes(data.peek(3 * self.size.itemsize))
        if blocks == 0 and expected == 0:
            return b""
        sizes = [full] * blocks if blocks <= expected else []
        if sizes and last:
            sizes[-1] = last
        if sum(sizes) != expected:
            msg = f"its {blocks} blocks do not make the {expected} bytes that are expected"
            raise ValueError(msg)
        packed = self._sizes(data.take((3 + blocks) * self.size.itemsize))[3:]
        stream = data.take(sum(packed))
        data.check_end()
        parts, at = [], 0
        for size, length in zip(sizes, packed, strict=True):
            parts.append(self._decompress(stream[at : at + length], size))
            at += length
        return b"".join(parts)

    def _sizes(self, header: bytes) -> list[int]:
        return [int(size) for size in np.frombuffer(header, self.size)]

    def _decompress(self, block: bytes, size: int) -> bytes:
        """One block, which must be whole and make so many bytes and no more."""
        if self.compressor == "vtkLZ4DataCompressor":
            data: bytes = optional("lz4.block", "this file").decompress(block, uncompressed_size=size)
        else:
            if self.compressor not in COMPRESSORS:
                known = ", ".join(["vtkLZ4DataCompressor", *COMPRESSORS])
                msg = f"compressed by {str(self.compressor)[:40]}; known are {known}"
                raise ValueError(msg)
            machine = COMPRESSORS[self.compressor]()
            data = machine.decompress(block, size + 1)
            if not machine.eof:
                msg = "a compressed block does not end"
                raise ValueError(msg)
        if len(data) != size:
            msg = f"a block makes {len(data)} bytes instead of {size}"
            raise ValueError(msg)
        return data


class _Bytes:
    """Bytes that are raw, or letters of base64 in parts that are padded each for itself.

    ``whole``: nothing may follow what is taken last.
    """

    def __init__(self, data: bytes | memoryview, *, letters: bool, whole: bool) -> None:
        self.data, self.letters, self.whole = data, letters, whole
        self.at = 0

    def peek(self, count: int) -> bytes:
        """The first bytes, without going past them."""
        if not self.letters:
            return self._checked(bytes(self.data[:count]), count)
        piece = self.data[: 4 * -(-count // 3)]
        return self._checked(base64.b64decode(piece, validate=True)[:count], count)

    def take(self, count: int) -> bytes:
        """The next bytes; in base64, a part that is padded for itself."""
        length = 4 * -(-count // 3) if self.letters else count
        piece = self.data[self.at : self.at + length]
        self.at += length
        return self._checked(base64.b64decode(piece, validate=True) if self.letters else bytes(piece), count)

    def take_after(self, header: int, count: int) -> bytes:
        """The bytes after a header, which VTK encodes together with them, and others apart."""
        apart = self.letters and b"=" in bytes(self.data[: 4 * -(-header // 3)])
        if not self.letters or apart:
            self.take(header)
            data = self.take(count)
        else:
            data = self.take(header + count)[header:]
        self.check_end()
        return data

    def check_end(self) -> None:
        """Raise a ValueError if letters are left where none may be."""
        if self.whole and self.at < len(self.data):
            msg = f"{len(self.data) - self.at} letters more than expected"
            raise ValueError(msg)

    @staticmethod
    def _checked(data: bytes, count: int) -> bytes:
        if len(data) != count:
            msg = f"{len(data)} bytes instead of {count}"
            raise ValueError(msg)
        return data

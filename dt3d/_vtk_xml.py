"""VTK's XML files, .vtu and .vtp: a head in XML, and behind it the bytes of each array as they are.

VTK's own writers are not used. They end the process where the disk is full, or else take several copies of
all arrays; and loading them takes longer than writing a million tetrahedra does.

Source: "VTK File Formats", section "XML File Formats"; for packed blocks, Kitware's page "VTK XML Formats".
"""

from __future__ import annotations

import math
import sys
import xml.etree.ElementTree as ET
import zlib
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ._numba.cores import available_cores

TETRA, TRIANGLE = 10, 5  # VTK's numbers of cell types
BLOCK = 1 << 20  # bytes that are packed together
LEVEL = 1  # of zlib: higher ones take several times as long, and gain some percent
SIZE = np.dtype(np.uint64)  # of the numbers before an array; those of four bytes end at 4 GB


@dataclass(frozen=True)
class XmlMesh:
    """Simplices of one kind, as VTK has them.

    Attributes
    ----------
    points : float64 (n, 3)
        All sites.
    simplices : int (m, k)
        Of 4 vertices, or of 3.
    cell_data, point_data : mapping of str to arrays
        With an entry for each cell, or point.
    active : str
        Which of the cell data, or else point data, are shown first; none if empty.
    """

    points: np.ndarray
    simplices: np.ndarray
    cell_data: Mapping[str, np.ndarray] = field(default_factory=dict)
    point_data: Mapping[str, np.ndarray] = field(default_factory=dict)
    active: str = ""


def write_xml(mesh: XmlMesh, path: Path, *, surface: bool = False, compress: bool = False) -> None:
    """Write a mesh.

    Parameters
    ----------
    mesh : XmlMesh
        What is written.
    path : Path
        The file, which is written from its beginning.
    surface : bool
        As polygons, .vtp, and not as an unstructured grid, .vtu.
    compress : bool
        Pack blocks of the arrays by zlib.

    Raises
    ------
    OSError
        If the file cannot be written.
    ValueError
        If data of points are no numbers.
    """
    kind = "PolyData" if surface else "UnstructuredGrid"
    root = ET.Element(
        "VTKFile",
        type=kind,
        version="1.0",
        byte_order=f"{sys.byteorder.capitalize()}Endian",
        header_type="UInt64",
    )
    if compress:
        root.set("compressor", "vtkZLibDataCompressor")
    m, corners = mesh.simplices.shape
    cells = "NumberOfPolys" if surface else "NumberOfCells"
    piece = ET.SubElement(
        ET.SubElement(root, kind), "Piece", {"NumberOfPoints": str(len(mesh.points)), cells: str(m)}
    )
    body = _Body(compress)
    for name, data in (("PointData", mesh.point_data), ("CellData", mesh.cell_data)):
        parent = ET.SubElement(piece, name, {"Scalars": mesh.active} if mesh.active in data else {})
        for key, values in data.items():
            body.add(parent, key, values)
    body.add(ET.SubElement(piece, "Points"), "Points", np.asarray(mesh.points, np.float64))
    listed = ET.SubElement(piece, "Polys" if surface else "Cells")
    body.add(listed, "connectivity", mesh.simplices.reshape(-1))
    number = np.int32 if corners * m < 2**31 else np.int64
    body.add(listed, "offsets", np.arange(corners, corners * (m + 1), corners, dtype=number))
    if not surface:
        body.add(listed, "types", np.full(m, TETRA if corners == 4 else TRIANGLE, np.uint8))
    head = ET.tostring(root, encoding="unicode", short_empty_elements=True)
    with path.open("wb") as file:
        file.write(b'<?xml version="1.0"?>\n' + head.removesuffix("</VTKFile>").encode())
        file.write(b'\n<AppendedData encoding="raw">\n_')
        for part in body.parts:
            file.write(part)
        file.write(b"\n</AppendedData>\n</VTKFile>\n")


class _Body:
    """The bytes behind the head, in parts, and how long they are."""

    def __init__(self, compress: bool) -> None:
        self.compress = compress
        self.parts: list[memoryview | bytes] = []
        self.length = 0

    def add(self, parent: ET.Element, name: str, values: np.ndarray) -> None:
        """Enter an array below an element of the head, and append its bytes."""
        values = as_numbers(name, values)
        kind = {"i": "Int", "u": "UInt", "f": "Float"}[values.dtype.kind] + str(8 * values.dtype.itemsize)
        array = ET.SubElement(parent, "DataArray", type=kind, Name=name, format="appended")
        array.set("offset", str(self.length))
        if values.ndim > 1:
            array.set("NumberOfComponents", str(math.prod(values.shape[1:])))
        data = values.reshape(-1).view(np.uint8).data
        for part in _packed(data) if self.compress else _counted(data):
            self.parts.append(part)
            self.length += len(part)


def as_numbers(name: str, values: np.ndarray) -> np.ndarray:
    """The array in a type that VTK has, in the machine's order of bytes; truth values are 0 and 1."""
    values = np.asarray(values)
    kind, size = values.dtype.kind, values.dtype.itemsize
    if kind == "b":
        values = values.astype(np.uint8)
    elif kind == "f" and size not in (4, 8):
        values = values.astype(np.float32 if size < 4 else np.float64)
    elif kind not in "iuf":
        msg = f"VTK's files hold numbers, and {name!r} has dtype {values.dtype}; leave it out, or write .npz"
        raise ValueError(msg)
    return np.ascontiguousarray(values, values.dtype.newbyteorder("="))


def _counted(data: memoryview) -> Sequence[memoryview | bytes]:
    return [np.array(len(data), SIZE).tobytes(), data]


def _packed(data: memoryview) -> Sequence[memoryview | bytes]:
    """Sizes, and blocks that threads have packed."""
    blocks = [data[at : at + BLOCK] for at in range(0, len(data), BLOCK)]
    with ThreadPoolExecutor(available_cores()) as pool:
        packed = list(pool.map(lambda block: zlib.compress(block, LEVEL), blocks))
    sizes = [len(blocks), BLOCK, len(data) % BLOCK, *map(len, packed)]
    return [np.array(sizes, SIZE).tobytes(), *packed]

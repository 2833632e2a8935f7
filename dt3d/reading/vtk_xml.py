"""Points and cells of VTK's XML files: .vtu .vtp .vti .vts .vtr, and .vtm, which names others.

Source: "VTK File Formats", section "XML File Formats". VTK's own reader is not used: where the letters of an
array are garbled it hands over uninitialised memory without a word, and a great number ends the process.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from .lattice import check_room, image, lattice
from .point_data import PointData, join
from .vtk_arrays import TYPES, Arrays
from .vtk_legacy import CELL_DATA

SERIAL = {
    "UnstructuredGrid": "Points",
    "PolyData": "Points",
    "StructuredGrid": "Points",
    "RectilinearGrid": "Coordinates",
    "ImageData": "",
}
"""The kinds of data set, and where a piece has its coordinates."""

ORIGIN = {"Origin": "0 0 0", "Spacing": "1 1 1"}
"""What an image has if it does not say."""


def read_xml(path: Path, keep: PointData | None = None) -> dict[str, np.ndarray]:
    """What the file has.

    Parameters
    ----------
    path : Path
        The file.
    keep : PointData, optional
        Gets the data of the points.

    Returns
    -------
    dict
        "points" (n, 3); of an unstructured grid "types" (m,), "offsets" (m + 1,) and "connectivity"; and the
        arrays of its cells by their names after `CELL_DATA`. Pieces are put one after the other.

    Raises
    ------
    ValueError
        If it is not whole XML, or an array has not the length or the letters that it should have.
    """
    root, arrays = _parse(path)
    kind = root.get("type", "")
    if kind == "vtkMultiBlockDataSet":
        return {"points": _blocks(path, root, keep)}
    if kind not in SERIAL:
        known = ", ".join([*SERIAL, "vtkMultiBlockDataSet"])
        msg = f"{path}: a VTKFile of type {kind[:40]!r}; known are {known}"
        raise ValueError(msg)
    grid = root.find(kind)
    pieces = [] if grid is None else grid.findall("Piece")
    if not pieces:
        msg = f"{path} holds no {kind} with a Piece"
        raise ValueError(msg)
    if kind in ("StructuredGrid", "RectilinearGrid", "ImageData") and len(pieces) > 1:
        msg = f"{path}: a {kind} in {len(pieces)} pieces is not read; save it as one"
        raise ValueError(msg)
    assert grid is not None
    found = [_piece(path, kind, grid, piece, arrays) for piece in pieces]
    if keep is not None:
        sizes = [len(part["points"]) for part in found]
        listed = [_point_data(path, piece, n, arrays) for piece, n in zip(pieces, sizes, strict=True) if n]
        join(keep, listed)
    points = np.concatenate([part["points"] for part in found])
    if not len(points):
        msg = f"{path} holds no points ({kind})"
        raise ValueError(msg)
    return {**_joined(found), "points": points}


def _parse(path: Path) -> tuple[ET.Element, Arrays]:
    """The tree, and the reader of its arrays, with the bytes that are appended to it."""
    data = path.read_bytes()
    tag = re.search(rb"<AppendedData\s+encoding\s*=\s*[\"'](raw|base64)[\"']\s*>\s*_", data)
    appended, base64 = memoryview(b""), True
    if tag is not None:
        end = data.rfind(b"</AppendedData>")
        if end < tag.end():
            msg = f"{path} is cut off: its appended data do not end"
            raise ValueError(msg)
        appended, base64 = memoryview(data)[tag.end() : end], tag[1] == b"base64"
        # raw bytes are no XML
        data = data[: tag.start()] + data[end + len(b"</AppendedData>") :]
    parser = ET.XMLParser(target=_NoEntities())
    try:
        parser.feed(data)
        root = parser.close()
    except ET.ParseError as error:
        msg = f"{path} is not whole XML: {error}" if data else f"{path} is empty"
        raise ValueError(msg) from error
    if root.tag != "VTKFile":
        msg = f"{path} is no VTK file: its root is {root.tag[:40]!r}"
        raise ValueError(msg)
    return root, Arrays(path, root, appended, base64)


class _NoEntities(ET.TreeBuilder):
    """Refuses a document type: its entities can make gigabytes of a few lines."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        msg = "a document type (DOCTYPE), which VTK's files do not have"
        raise ValueError(msg)


def _piece(
    path: Path, kind: str, grid: ET.Element, piece: ET.Element, arrays: Arrays
) -> dict[str, np.ndarray]:
    if kind == "ImageData":
        origin, spacing = ([float(v) for v in grid.get(k, d).split()] for k, d in ORIGIN.items())
        turn = np.array([float(v) for v in grid.get("Direction", "1 0 0 0 1 0 0 0 1").split()]).reshape(3, 3)
        return {"points": image(path, _extent(path, grid), origin, spacing, turn)}
    listed = piece.find(SERIAL[kind])
    parts = [] if listed is None else listed.findall("DataArray")
    if kind == "RectilinearGrid":
        extent = _extent(path, grid)
        sizes = [extent[k + 1] - extent[k] + 1 for k in (0, 2, 4)]
        if len(parts) != 3:
            msg = f"{path}: expected three arrays of coordinates, found {len(parts)}"
            raise ValueError(msg)
        return {"points": lattice(path, [arrays.read(p, n) for p, n in zip(parts, sizes, strict=True)])}
    if kind == "StructuredGrid":
        extent = _extent(path, grid)
        n = int(np.prod([extent[k + 1] - extent[k] + 1 for k in (0, 2, 4)], dtype=object))
    else:
        n = _number(path, piece, "NumberOfPoints")
    if n == 0:
        return {"points": np.empty((0, 3))}
    check_room(path, n, "points that are promised")
    if len(parts) != 1 or parts[0].get("NumberOfComponents", "1") != "3":
        msg = f"{path}: expected one array of points with three components, found {len(parts)}"
        raise ValueError(msg)
    found = {"points": arrays.read(parts[0], 3 * n).reshape(n, 3)}
    if kind == "UnstructuredGrid" and (cells := _number(path, piece, "NumberOfCells")):
        found |= _cells(path, piece, cells, arrays)
    return found


def _point_data(path: Path, piece: ET.Element, n: int, arrays: Arrays) -> PointData:
    """The data of the n points of a piece."""
    found = PointData()
    for array in piece.findall("PointData/*"):
        name, kind = array.get("Name", ""), array.get("type", "")
        if array.tag != "DataArray" or kind not in TYPES:
            why = "text of VTK's XML files is not read" if kind == "String" else f"its type is {kind[:40]!r}"
            found.leave_out(name, why)
            continue
        # VTK itself writes 0 or nothing for scalars
        width = _number(path, array, "NumberOfComponents") or 1
        values = arrays.read(array, n * width).reshape(n, width)
        found.add(name, values, TYPES[kind] if array.get("format", "ascii") == "ascii" else None)
    return found


def _cells(path: Path, piece: ET.Element, m: int, arrays: Arrays) -> dict[str, np.ndarray]:
    listed = {array.get("Name"): array for array in piece.findall("Cells/DataArray")}
    if missing := {"connectivity", "offsets", "types"} - listed.keys():
        msg = f"{path}: the cells have no array {' and none '.join(sorted(missing))}"
        raise ValueError(msg)
    ends = arrays.read(listed["offsets"], m)
    last = int(ends[-1])
    found = {
        "offsets": np.append(0, ends),
        "connectivity": arrays.read(listed["connectivity"], last),
        "types": arrays.read(listed["types"], m),
    }
    for array in piece.findall("CellData/DataArray"):
        if array.get("Name") in ("iteration", "medit:ref") and array.get("NumberOfComponents", "1") == "1":
            found[CELL_DATA + array.get("Name", "")] = arrays.read(array, m)
    return found


def _joined(pieces: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """The cells of all pieces, with the numbers that points have where one piece follows the other."""
    with_cells = [(k, piece) for k, piece in enumerate(pieces) if "types" in piece]
    if not with_cells:
        return {}
    before = np.cumsum([0] + [len(piece["points"]) for piece in pieces])
    names = set.intersection(*(set(piece) for _, piece in with_cells)) - {"points", "offsets", "connectivity"}
    found = {name: np.concatenate([piece[name] for _, piece in with_cells]) for name in names}
    found["connectivity"] = np.concatenate([piece["connectivity"] + before[k] for k, piece in with_cells])
    sizes = np.concatenate([np.diff(piece["offsets"]) for _, piece in with_cells])
    return {**found, "offsets": np.append(0, np.cumsum(sizes))}


def _blocks(path: Path, root: ET.Element, keep: PointData | None) -> np.ndarray:
    """The points of all files that a multi-block file names, in its order."""
    found, data = [], []
    for block in root.iter("DataSet"):
        if (name := block.get("file")) is None:
            continue
        part = path.parent / name
        if part.suffix.lower() not in (".vtu", ".vtp", ".vti", ".vts", ".vtr"):
            msg = f"{path} names {name!r}, which is no file that is read as a block"
            raise ValueError(msg)
        if not part.is_file():
            msg = f"{path} names the block {name!r}, and there is no such file"
            raise ValueError(msg)
        data.append(PointData())
        found.append(read_xml(part, None if keep is None else data[-1])["points"])
        data[-1].check(str(part), len(found[-1]))
    if not found:
        msg = f"{path} names no files of blocks"
        raise ValueError(msg)
    join(keep, data)
    return np.concatenate(found)


def _number(path: Path, piece: ET.Element, name: str) -> int:
    text = piece.get(name, "0")
    if not (text.isdecimal() and text.isascii()) or len(text) > 18:
        msg = f"{path}: {name} should be a number, found {text[:40]!r}"
        raise ValueError(msg)
    return int(text)


def _extent(path: Path, grid: ET.Element) -> list[int]:
    words = grid.get("WholeExtent", "").split()
    extent = [int(word) for word in words if len(word) < 12]
    if len(extent) != 6 or any(extent[k] > extent[k + 1] for k in (0, 2, 4)):
        msg = f"{path}: WholeExtent should be three pairs of a first and a last index, found {words[:6]}"
        raise ValueError(msg)
    return extent

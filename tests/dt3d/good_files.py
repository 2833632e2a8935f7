"""A whole file of every format that is not a table of text, with the points that it holds, and ways to spoil it."""

from __future__ import annotations

import base64
import gzip
import lzma
import struct
import zlib
from collections.abc import Callable, Iterator
from itertools import combinations, product
from pathlib import Path

import numpy as np

# three decimals, so that single precision and scaled integers hold them as well as text does
POINTS = np.array(list(product([0.125, 2.5, -1.75], [4.0, 0.625, 11.0], [-3.25, 7.5]))) + 0.0
TETRAHEDRA = np.array(list(combinations(range(9), 4)))[::7].astype(np.int32)
ROWS = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in POINTS.tolist())
CELLS = "".join("4 " + " ".join(map(str, row)) + "\n" for row in TETRAHEDRA.tolist())
N, M = len(POINTS), len(TETRAHEDRA)


def npy(path: Path) -> None:
    np.save(path, POINTS)


def npz(path: Path) -> None:
    np.savez(path, points=POINTS, simplices=TETRAHEDRA)


def npz_packed(path: Path) -> None:
    np.savez_compressed(path, points=POINTS, simplices=TETRAHEDRA)


def ply(path: Path, form: str = "ascii", faces: bool = True) -> None:
    header = f"ply\nformat {form} 1.0\ncomment made by hand\nelement camera 1\nproperty float fov\n"
    header += f"element vertex {N}\n" + "".join(f"property double {axis}\n" for axis in "xyz")
    header += "property list uchar int near\n"
    header += "element face 2\nproperty list uchar int vertex_indices\n" * faces + "end_header\n"
    if form == "ascii":
        rows = ROWS.replace("\n", " 2 0 1\n")
        path.write_text(header + "45\n" + rows + "3 0 1 2\n4 0 1 2 3\n" * faces)
        return
    order = "<" if form == "binary_little_endian" else ">"
    rows = b"".join(struct.pack(order + "3dB2i", *row, 2, 0, 1) for row in POINTS.tolist())
    tail = struct.pack(order + "B3iB4i", 3, 0, 1, 2, 4, 0, 1, 2, 3)
    path.write_bytes(header.encode() + struct.pack(order + "f", 45) + rows + tail * faces)


def stl(path: Path) -> None:
    rows = b"".join(struct.pack("<12fH", 0, 0, 1, *POINTS[list(t)].ravel(), 0) for t in _triangles())
    path.write_bytes(b"solid, says the header of this binary file".ljust(80) + struct.pack("<I", N) + rows)


def stl_text(path: Path) -> None:
    lines = ["solid cloud"]
    for t in _triangles():
        lines += ["facet normal 0 0 1", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in POINTS[list(t)].tolist()] + ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid cloud", ""]))


def _triangles() -> list[tuple[int, int, int]]:
    """As many as points, which appear in their order."""
    return [(0, 1, 2), *((k, k - 1, k - 2) for k in range(3, N)), (0, 1, 2), (3, 4, 5)]


def vtk(path: Path, form: str = "ASCII", version: str = "5.1") -> None:
    """An unstructured grid with the iteration of each cell, in the words of VTK's own writer."""
    binary = form == "BINARY"
    offsets = np.arange(M + 1) * 4

    def numbers(array: np.ndarray, dtype: str) -> bytes:
        if binary:
            return array.astype(dtype).tobytes() + b"\n"
        return (" ".join(map(repr, array.ravel().tolist())) + "\n").encode()

    out = f"# vtk DataFile Version {version}\nmade by hand\n{form}\nDATASET UNSTRUCTURED_GRID\n".encode()
    out += f"POINTS {N} double\n".encode() + numbers(POINTS, ">f8")
    out += b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1 \n\n"
    if version == "5.1":
        out += f"CELLS {M + 1} {4 * M}\nOFFSETS vtktypeint64\n".encode() + numbers(offsets, ">i8")
        out += b"CONNECTIVITY vtktypeint64\n" + numbers(TETRAHEDRA, ">i8")
    else:
        packed = np.column_stack([np.full(M, 4), TETRAHEDRA])
        out += f"CELLS {M} {5 * M}\n".encode() + numbers(packed, ">i4")
    out += f"CELL_TYPES {M}\n".encode() + numbers(np.full(M, 10), ">i4")
    out += f"CELL_DATA {M}\nFIELD FieldData 1\niteration 1 {M} int\n".encode() + numbers(np.arange(M), ">i4")
    path.write_bytes(out)


def vtu(path: Path, form: str = "ascii", compressor: str = "", encoding: str = "base64") -> None:
    """An unstructured grid in XML; ``form`` ascii, binary or appended."""
    arrays = [
        ("Points", "Float64", POINTS.astype("<f8")),
        ("connectivity", "Int64", TETRAHEDRA.astype("<i8")),
        ("offsets", "Int64", np.arange(4, 4 * M + 1, 4).astype("<i8")),
        ("types", "UInt8", np.full(M, 10, "u1")),
        ("iteration", "Int32", np.arange(M, dtype="<i4")),
    ]
    appended, tags = b"", {}
    for name, kind, array in arrays:
        tag = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{3 if name == "Points" else 1}" '
        if form == "ascii":
            text = " ".join(map(repr, array.ravel().tolist()))
            tags[name] = f'{tag}format="ascii">\n{text}\n</DataArray>'
            continue
        data = packed(array.tobytes(), compressor, encoding)
        if form == "binary":
            tags[name] = f'{tag}format="binary">\n  {data.decode()}\n</DataArray>'
        else:
            tags[name] = f'{tag}format="appended" offset="{len(appended)}"/>'
            appended += data
    attribute = f' compressor="{compressor}"' if compressor else ""
    text = (
        f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        f'header_type="UInt64"{attribute}>\n<UnstructuredGrid>\n<Piece NumberOfPoints="{N}" NumberOfCells="{M}">\n'
        f"<Points>{tags['Points']}</Points>\n"
        f"<Cells>{tags['connectivity']}{tags['offsets']}{tags['types']}</Cells>\n"
        f"<CellData>{tags['iteration']}</CellData>\n</Piece>\n</UnstructuredGrid>\n"
    ).encode()
    if form == "appended":
        text += f'<AppendedData encoding="{encoding}">_'.encode() + appended + b"</AppendedData>\n"
    path.write_bytes(text + b"</VTKFile>\n")


def packed(data: bytes, compressor: str, encoding: str) -> bytes:
    """An array as VTK's XML has it: a header of sizes and the bytes, in blocks of 128 if they are compressed."""
    code = base64.b64encode if encoding == "base64" else bytes
    if not compressor:
        return code(struct.pack("<Q", len(data)) + data)
    block = 128
    parts = [data[k : k + block] for k in range(0, len(data), block)]
    pack = {"vtkZLibDataCompressor": zlib.compress, "vtkLZMADataCompressor": lzma.compress}[compressor]
    small = [pack(part) for part in parts]
    header = struct.pack(f"<{3 + len(parts)}Q", len(parts), block, len(data) % block, *map(len, small))
    return code(header) + code(b"".join(small))


def vtp(path: Path) -> None:
    data = packed(POINTS.astype("<f8").tobytes(), "vtkZLibDataCompressor", "base64").decode()
    path.write_text(
        '<VTKFile type="PolyData" byte_order="LittleEndian" header_type="UInt64" '
        f'compressor="vtkZLibDataCompressor"><PolyData><Piece NumberOfPoints="{N}"><Points>'
        f'<DataArray type="Float64" NumberOfComponents="3" format="binary">{data}</DataArray>'
        "</Points></Piece></PolyData></VTKFile>"
    )


def gmsh(path: Path, version: str = "4.1", binary: bool = False) -> None:
    """Nodes with the tags 11, 12, ... in two blocks, and a triangle before the tetrahedra."""
    size, tags, half = ("Q", np.arange(N) + 11, N // 2)
    out = [f"$MeshFormat\n{version} {int(binary)} 8\n".encode()]

    def put(form: str, *values: float) -> None:
        text = (" ".join(map(repr, values)) + "\n").encode()
        out.append(struct.pack("<" + form, *values) if binary else text)

    if binary:
        out += [struct.pack("<i", 1), b"\n"]
    out.append(b"$EndMeshFormat\n$Comments\nmade by hand\n$EndComments\n$Nodes\n")
    if version == "4.1":
        put(f"4{size}", 2, N, 11, 10 + N)
        for part in (slice(0, half), slice(half, N)):
            points, names = POINTS[part].ravel().tolist(), tags[part].tolist()
            put("3i", 3, 1, 0), put(size, len(names))
            put(f"{len(names)}{size}", *names), put(f"{len(points)}d", *points)
        out.append(b"\n$EndNodes\n$Elements\n" if binary else b"$EndNodes\n$Elements\n")
        put(f"4{size}", 2, M + 1, 1, M + 1)
        put("3i", 2, 1, 2), put(size, 1), put(f"4{size}", 1, *tags[:3].tolist())
        put("3i", 3, 1, 4), put(size, M)
        rows = np.column_stack([np.arange(M) + 2, tags[TETRAHEDRA]]).ravel().tolist()
        put(f"{len(rows)}{size}", *rows)
    else:
        out.append(f"{N}\n".encode())
        for tag, point in zip(tags.tolist(), POINTS.tolist(), strict=True):
            put("i3d", tag, *point)
        out.append(f"$EndNodes\n$Elements\n{M + 1}\n".encode())
        if binary:
            put("3i", 2, 1, 2)
        put("6i" if binary else "", *([1, 0, 0] if binary else [1, 2, 2, 0, 0]), *tags[:3].tolist())
        if binary:
            put("3i", 4, M, 2)
        for k, row in enumerate(tags[TETRAHEDRA].tolist()):
            put("7i", *([k + 2, 0, 0] if binary else [k + 2, 4, 2, 0, 0]), *row)
    out.append(b"\n$EndElements\n" if binary else b"$EndElements\n")
    path.write_bytes(b"".join(out))


def medit(path: Path) -> None:
    cells = "".join(" ".join(map(str, row)) + " 7\n" for row in (TETRAHEDRA + 1).tolist())
    path.write_text(
        f"MeshVersionFormatted 2\n# by hand\nDimension 3\nVertices {N}\n" + ROWS.replace("\n", " 0\n")
        + f"Triangles 1\n1 2 3 0\nTetrahedra {M}\n{cells}End\n"
    )  # fmt: skip


def pcd(path: Path, form: str = "ascii") -> None:
    """With an intensity that has a count of two."""
    header = "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z\nSIZE 4 8 8 8\nTYPE U F F F\nCOUNT 2 1 1 1\n"
    header += f"WIDTH {N}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {N}\nDATA {form}\n"
    if form == "ascii":
        body = "".join(f"1 2 {row}\n" for row in ROWS.splitlines()).encode()
    elif form == "binary":
        body = b"".join(struct.pack("<2I3d", 1, 2, *row) for row in POINTS.tolist())
    else:
        plain = struct.pack("<2I", 1, 2) * N + POINTS.T.astype("<f8").tobytes()
        small = lzf(plain)
        body = struct.pack("<2I", len(small), len(plain)) + small
    path.write_bytes(header.encode() + body)


def lzf(data: bytes) -> bytes:
    """LZF by the simplest search: the longest copy from the last 60 bytes, or a literal."""
    out, literal, at = bytearray(), bytearray(), 0

    def flush() -> None:
        for k in range(0, len(literal), 32):
            part = literal[k : k + 32]
            out.extend([len(part) - 1, *part])
        literal.clear()

    while at < len(data):
        best, distance = 0, 0
        for back in range(1, min(at, 60) + 1):
            length = 0
            while at + length < len(data) and length < 264 and data[at + length] == data[at - back + length]:
                length += 1
            if length > best:
                best, distance = length, back
        if best < 3:
            literal.append(data[at])
            at += 1
            continue
        flush()
        length, far = best - 2, distance - 1
        out.extend([(min(length, 7) << 5) | far >> 8] + [length - 7] * (length >= 7) + [far & 255])
        at += best
    flush()
    return bytes(out)


def las(path: Path) -> None:
    import laspy

    header = laspy.LasHeader(point_format=0, version="1.2")
    header.scales, header.offsets = [0.125] * 3, [1.0, 2.0, 3.0]
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = POINTS.T
    cloud.write(path)


FILES: dict[str, tuple[str, Callable[[Path], None]]] = {
    "npy": (".npy", npy),
    "npz": (".npz", npz),
    "npz compressed": (".npz", npz_packed),
    "ply text": (".ply", ply),
    "ply little endian": (".ply", lambda path: ply(path, "binary_little_endian")),
    "ply big endian": (".ply", lambda path: ply(path, "binary_big_endian")),
    "stl": (".stl", stl),
    "stl text": (".stl", stl_text),
    "vtk text": (".vtk", vtk),
    "vtk binary": (".vtk", lambda path: vtk(path, "BINARY")),
    "vtk text 4.2": (".vtk", lambda path: vtk(path, version="4.2")),
    "vtk binary 4.2": (".vtk", lambda path: vtk(path, "BINARY", "4.2")),
    "vtu text": (".vtu", vtu),
    "vtu base64": (".vtu", lambda path: vtu(path, "binary")),
    "vtu zlib": (".vtu", lambda path: vtu(path, "binary", "vtkZLibDataCompressor")),
    "vtu raw": (".vtu", lambda path: vtu(path, "appended", encoding="raw")),
    "vtu appended": (".vtu", lambda path: vtu(path, "appended", "vtkLZMADataCompressor")),
    "vtu raw zlib": (".vtu", lambda path: vtu(path, "appended", "vtkZLibDataCompressor", "raw")),
    "vtp": (".vtp", vtp),
    "gmsh text": (".msh", gmsh),
    "gmsh binary": (".msh", lambda path: gmsh(path, binary=True)),
    "gmsh text 2.2": (".msh", lambda path: gmsh(path, "2.2")),
    "gmsh binary 2.2": (".msh", lambda path: gmsh(path, "2.2", True)),
    "medit": (".mesh", medit),
    "pcd text": (".pcd", pcd),
    "pcd binary": (".pcd", lambda path: pcd(path, "binary")),
    "pcd compressed": (".pcd", lambda path: pcd(path, "binary_compressed")),
    "las": (".las", las),
    "laz": (".laz", las),
}
"""The extension and the writer of a whole file, by a name for it."""

MESHES = [name for name in FILES if name.partition(" ")[0] in ("npz", "vtk", "vtu", "gmsh", "medit")]
"""Those that have TETRAHEDRA, too."""


def whole(folder: Path, name: str) -> Path:
    """A whole file of this kind."""
    extension, writer = FILES[name]
    path = folder / f"whole{extension}"
    writer(path)
    return path


def gzipped(path: Path) -> Path:
    """The same file, packed by gzip."""
    packed = path.with_name(path.name + ".gz")
    packed.write_bytes(gzip.compress(path.read_bytes()))
    return packed


def corruptions(data: bytes, seed: int) -> Iterator[tuple[str, bytes]]:
    """Endless ways to spoil a file, each with its kind: the same ones for the same seed."""
    rng = np.random.default_rng(seed)
    digits = [k for k in range(min(len(data), 1200)) if 48 <= data[k] < 58]
    yield "empty", b""
    yield "zeros", bytes(len(data))
    yield "garbage", rng.bytes(len(data))
    while True:
        yield "cut", data[: int(rng.integers(1, len(data)))]
        bad = bytearray(data)
        for _ in range(int(rng.integers(1, 11))):
            bad[int(rng.integers(len(bad)))] = int(rng.integers(256))
        yield "bytes", bytes(bad)
        yield "cut", data[: len(data) - int(rng.integers(1, 40))]
        at = int(rng.integers(len(data)))
        yield "block", data[:at] + bytes(min(100, len(data) - at)) + data[at + 100 :]
        if digits:
            at = digits[int(rng.integers(len(digits)))]
            yield "lie", data[:at] + b"9" * int(rng.integers(1, 10)) + data[at:]
            at = digits[int(rng.integers(len(digits)))]
            yield "digit", data[:at] + b"%d" % rng.integers(10) + data[at + 1 :]
        bad = bytearray(data)
        at = int(rng.integers(min(len(bad) - 8, 400)))
        bad[at : at + 8] = struct.pack("<Q", int(2 ** rng.uniform(0, 64)))
        yield "number", bytes(bad)

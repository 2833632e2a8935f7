"""Files that are broken at random: cut off, with other bytes, with counts that are not true."""

from __future__ import annotations

import contextlib
import gzip
import io
import os
import re
import resource
import struct
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import dt3d
from dt3d.files import read_cloud, read_mesh, read_points, write_mesh

from .families import Rng
from .oracle import require

MESHES = (".vtu", ".vtk", ".npz", ".msh", ".mesh")  # of which `read_mesh` is tried, too
ADDRESS_SPACE = 16 << 30  # bytes; who believes a count that is not true asks for more


def sites(n: int = 12) -> np.ndarray:
    """Points whose coordinates every format holds, float64 (n, 3): three digits."""
    return np.random.default_rng(n).integers(-999, 1000, (n, 3)) / 8


def _rows(points: np.ndarray, form: str = "{} {} {}") -> str:
    return "".join(form.format(*row) + "\n" for row in points.tolist())


def _ply(points: np.ndarray, form: str) -> bytes:
    head = f"ply\nformat {form} 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    if form == "ascii":
        return (head + _rows(points)).encode()
    return head.encode() + points.astype("<f8" if "little" in form else ">f8").tobytes()


def _pcd(points: np.ndarray, form: str) -> bytes:
    n = len(points)
    head = "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\n"
    head += f"WIDTH {n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA {form}\n"
    return head.encode() + (_rows(points).encode() if form == "ascii" else points.tobytes())


def _stl(points: np.ndarray) -> bytes:
    triangles = points[: len(points) // 3 * 3].reshape(-1, 3, 3).astype("<f4")
    body = b"".join(bytes(12) + corners.tobytes() + bytes(2) for corners in triangles)
    return b"binary".ljust(80) + struct.pack("<I", len(triangles)) + body


def _npy(*arrays: np.ndarray, **named: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    if named:
        np.savez_compressed(buffer, **named)
    else:
        np.save(buffer, *arrays)
    return buffer.getvalue()


def _las(points: np.ndarray) -> bytes:
    import laspy

    las = laspy.LasData(laspy.LasHeader(point_format=3, version="1.2"))
    las.header.scales = [0.125] * 3
    las.x, las.y, las.z = points.T
    buffer = io.BytesIO()
    las.write(buffer)
    return buffer.getvalue()


def _pdb(points: np.ndarray) -> bytes:
    form = "ATOM  {:5d}  CA  ALA A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C\n"
    return "".join(form.format(i + 1, i + 1, *row) for i, row in enumerate(points.tolist())).encode()


@cache
def samples() -> dict[str, tuple[bytes, np.ndarray]]:
    """Whole files by name, and the points in them."""
    points = sites()
    n = len(points)
    text = {
        "table.csv": _rows(points, "{},{},{}"),
        "header.csv": "x,y,z\n" + _rows(points, "{},{},{}"),
        "decimal-commas.csv": _rows(points, "{};{};{}").replace(".", ","),
        "table.tsv": _rows(points, "{}\t{}\t{}"),
        "table.txt": _rows(points),
        "table.asc": _rows(points),
        "table.dat": _rows(points),
        "count.pts": f"{n}\n" + _rows(points),
        "table.xyz": _rows(points),
        "chemistry.xyz": f"{n}\ncomment\n" + _rows(points, "C {} {} {}"),
        "vertices.obj": _rows(points, "v {} {} {}") + "f 1 2 3\n",
        "vertices.off": f"OFF\n{n} 1 0\n" + _rows(points) + "3 0 1 2\n",
        "tetgen.node": f"{n} 3 0 0\n" + "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(points)),
    }
    files = {name: content.encode() for name, content in text.items()} | {
        "atoms.pdb": _pdb(points),
        "array.npy": _npy(points),
        "array.npz": _npy(points=points),
        "xyz.npz": _npy(**dict(zip("xyz", points.T, strict=True))),
        "ascii.ply": _ply(points, "ascii"),
        "little.ply": _ply(points, "binary_little_endian"),
        "big.ply": _ply(points, "binary_big_endian"),
        "ascii.pcd": _pcd(points, "ascii"),
        "binary.pcd": _pcd(points, "binary"),
        "scan.las": _las(points),
        "packed.csv.gz": gzip.compress(_rows(points, "{},{},{}").encode(), mtime=0),
    }
    known = {name: (data, points) for name, data in files.items()}
    known["triangles.stl"] = (_stl(points), points)
    return known | {name: (data, points) for name, data in _written(points).items()}


def _written(points: np.ndarray) -> dict[str, bytes]:
    """What libraries write: meshes of all formats, and VTK's other files, as text and as bytes."""
    import pyvista as pv

    tri = dt3d.Delaunay(points)
    cloud = pv.PolyData(points)
    cloud["heat"], cloud["flow field"] = points[:, 0].astype(np.float32), points
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for extension in MESHES:
            write_mesh(tri, folder / f"mesh{extension}")
        for binary, form in ((True, "binary"), (False, "ascii")):
            cloud.save(folder / f"cloud-{form}.vtp", binary=binary)
            cloud.save(folder / f"cloud-{form}.vtk", binary=binary)
            tri.to_pyvista().save(folder / f"grid-{form}.vtk", binary=binary)
            tri.to_pyvista().save(folder / f"grid-{form}.vtu", binary=binary)
        return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def truncate(rng: Rng, data: bytes) -> bytes:
    return data[: int(rng.integers(0, len(data)))]


def other_bytes(rng: Rng, data: bytes) -> bytes:
    changed = bytearray(data)
    for i in rng.integers(0, len(data), int(rng.choice([1, 1, 3, 10]))):
        changed[i] = int(rng.integers(256))
    return bytes(changed)


def zeros(rng: Rng, data: bytes) -> bytes:
    i, j = sorted(rng.integers(0, len(data) + 1, 2))
    return data[:i] + bytes(j - i) + data[j:]


def left_out(rng: Rng, data: bytes) -> bytes:
    i = int(rng.integers(0, len(data)))
    return data[:i] + data[i + int(rng.choice([1, 2, 8, 50])) :]


def twice(rng: Rng, data: bytes) -> bytes:
    i, j = sorted(rng.integers(0, len(data) + 1, 2))
    return data[:j] + data[i:j] + data[j:]


def another_count(rng: Rng, data: bytes) -> bytes:
    """One of the whole numbers in the text of a file is another one."""
    numbers = list(re.finditer(rb"(?<![\d.])\d+(?![\d.])", data[:2000]))
    if not numbers:
        return other_bytes(rng, data)
    found = numbers[int(rng.integers(len(numbers)))]
    lie = str(rng.choice(["0", "1", "-1", "7", "13", "4000000000", "99999999999999999999", "1e9", "nan", ""]))
    return data[: found.start()] + lie.encode() + data[found.end() :]


def another_integer(rng: Rng, data: bytes) -> bytes:
    """Four or eight bytes in the first half kilobyte are a number that promises too much, or nothing."""
    width = int(rng.choice([4, 8]))
    at = int(rng.integers(0, max(1, min(len(data), 512) - width)))
    lie = int(rng.choice([0, 1, 2**31 - 1, 2**32 - 1, 2**62])) % 2 ** (8 * width)
    return data[:at] + lie.to_bytes(width, "little") + data[at + width :]


def garbage(rng: Rng, data: bytes) -> bytes:
    keep = int(rng.choice([0, 0, 4, 40]))
    return data[:keep] + rng.bytes(int(rng.integers(0, 500)))


CORRUPTIONS: dict[str, Callable[[Rng, bytes], bytes]] = {
    f.__name__: f
    for f in (truncate, other_bytes, zeros, left_out, twice, another_count, another_integer, garbage)
}


def corrupted(name: str, k: int) -> tuple[str, bytes]:
    """A broken version of a sample, and how it was broken; the same for the same k."""
    data, _ = samples()[name]
    rng = np.random.default_rng([k, len(name)])
    kind = list(CORRUPTIONS)[k % len(CORRUPTIONS)]
    return kind, CORRUPTIONS[kind](rng, data)


def file_trial(name: str, k: int) -> list[str]:
    """Read a broken file: it is points again, the same ones each time, or an error of one line.

    Raises
    ------
    Refuted
        If something else happens.
    """
    kind, data = corrupted(name, k)
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, resource.getrlimit(resource.RLIMIT_AS)[1]))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(data)
        outcome, found = _read(_points, path)
        if outcome == "read":
            require(found.dtype == np.float64, "points are float64")
            require(found.ndim == 2 and found.shape[1] in (2, 3), "points have two or three coordinates")
            again = _read(_points, path)[1]
            require(np.array_equal(found, again, equal_nan=True), "the same file has the same points")
            if kind == "truncate":
                _require_prefix(found, samples()[name][1])
        _read(_cloud, path)
        if path.suffix in MESHES:
            _read(read_mesh, path)
    return [kind, outcome]


def command_trial(name: str, k: int) -> list[str]:
    """The same through the command line: a mesh and status 0, or one line and status 2; never half a mesh.

    Raises
    ------
    Refuted
        If something else happens.
    """
    from dt3d.cli import main

    kind, data = corrupted(name, k)
    with tempfile.TemporaryDirectory() as folder:
        path, mesh = Path(folder) / name, Path(folder) / "mesh.npz"
        path.write_bytes(data)
        mesh.write_bytes(b"an older one")
        with _printed() as texts:
            status = main(["triangulate", str(path), "--output", str(mesh)])
        lines = texts[1].splitlines()
        if status == 0:
            require("wrote" in texts[0], "a command that is done says what it wrote")
            require(read_points(mesh, dimension=None).size > 0, "the mesh is whole")
        else:
            require(status == 2, f"bad files have status 2, not {status}: {lines}")
            require(len(lines) == 1, f"an error is one line: {lines}")
            # what is wrong with points that could be read is said of the points
            require(name in lines[0] or "points from" in texts[0], f"it names the file: {lines}")
            require(mesh.read_bytes() == b"an older one", "an older file stays as it was")
        if path.suffix in MESHES:
            with _printed() as texts:
                proved = main(["verify", str(path)])
            lines = texts[1].splitlines()
            require(proved in (0, 1) or (proved == 2 and len(lines) == 1), f"verify: {proved}, {lines}")
    return [kind, "read" if status == 0 else "refused"]


@contextlib.contextmanager
def _printed() -> Iterator[list[str]]:
    """What is printed within, by other languages too: standard output and errors, there when it has ended."""
    texts: list[str] = []
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        kept = os.dup(1), os.dup(2)
        os.dup2(out.fileno(), 1)
        os.dup2(err.fileno(), 2)
        try:
            yield texts
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for descriptor, old in zip((1, 2), kept, strict=True):
                os.dup2(old, descriptor)
                os.close(old)
            for file in (out, err):
                file.seek(0)
                texts.append(file.read().decode(errors="replace"))


def _points(path: Path) -> np.ndarray:
    return read_points(path, dimension=None)


def _cloud(path: Path) -> np.ndarray:
    cloud = read_cloud(path, dimension=None)
    for name, values in cloud.point_data.items():
        require(len(values) == len(cloud.points), f"{name} has an entry for each point")
    return cloud.points


def _require_prefix(found: np.ndarray, whole: np.ndarray) -> None:
    """What is left of a file has the points that were there; of the last one the end may be missing."""
    require(len(found) <= len(whole), "there are no more points than there were")
    sure = len(found) - 1
    if sure < 1:  # a row that is cut may look like a whole one of two coordinates
        return
    require(np.array_equal(found[:sure], whole[:sure]), "a file that was cut off has its first points")


def _read(reader: Callable[[Path], Any], path: Path) -> tuple[str, Any]:
    """("read", what was read) or ("refused", the line), with nothing printed."""
    with _printed() as texts:
        try:
            outcome: tuple[str, Any] = "read", reader(path)
        except (ValueError, OSError) as error:
            outcome = "refused", str(error)
    noise = "".join(texts)
    require(not noise, f"nothing is printed: {noise[:200]!r}")
    if outcome[0] == "refused":
        require(outcome[1] and "\n" not in outcome[1], f"an error is one line: {outcome[1]!r}")
        require(path.name in outcome[1], f"an error names the file: {outcome[1]!r}")
    return outcome

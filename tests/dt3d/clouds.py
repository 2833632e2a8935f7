"""Clouds with data of their points, and files of every kind that has them."""

import struct

import laspy
import meshio
import numpy as np
import pyvista as pv

N = 60
RANDOM = np.random.default_rng(11)
POINTS = np.round(256 * RANDOM.random((N, 3))) / 256  # which scaled integers and text hold
POINTS[-1] = POINTS[0]  # a site that is not used
DATA = {
    "temperature": np.round(RANDOM.random(N), 3).astype(np.float32),
    "big": 2**40 + np.arange(N),
    "class": (np.arange(N) % 5).astype(np.uint8),
    "velocity": np.round(RANDOM.random((N, 3)), 3),  # text of VTK has twelve digits
    "pair": np.arange(2 * N, dtype=np.int16).reshape(N, 2),
}


def cloud():
    """A dataset of PyVista with all that it holds."""
    dataset = pv.PolyData(POINTS)
    for name, values in DATA.items():
        dataset.point_data[name] = values
    return dataset


def structured():
    table = np.zeros(
        N, [(axis, "f8") for axis in "xyz"] + [(k, v.dtype, v.shape[1:]) for k, v in DATA.items()]
    )
    for axis, column in zip("xyz", POINTS.T, strict=True):
        table[axis] = column
    for name, values in DATA.items():
        table[name] = values
    return table


def ply(path, order):
    kinds = {"f8": "double", "f4": "float", "u1": "uchar", "i4": "int"}
    columns = {**dict(zip("xyz", POINTS.T, strict=True)), **SCALARS}
    header = f"ply\nformat {order} 1.0\nelement vertex {N}\n"
    header += "".join(f"property {kinds[v.dtype.str[1:]]} {k}\n" for k, v in columns.items()) + "end_header\n"
    if order == "ascii":
        rows = zip(*[v.tolist() for v in columns.values()], strict=True)
        path.write_text(header + "".join(" ".join(map(repr, row)) + "\n" for row in rows))
        return
    sign = "<" if "little" in order else ">"
    table = np.zeros(N, [(k, v.dtype.newbyteorder(sign)) for k, v in columns.items()])
    for name, values in columns.items():
        table[name] = values
    path.write_bytes(header.encode() + table.tobytes())


SCALARS = {
    "temperature": DATA["temperature"],
    "class": DATA["class"],
    "label": np.arange(N, dtype=np.int32) - 7,
    "energy": RANDOM.random(N),
}


def pcd(path, form):
    fields = {**dict(zip("xyz", POINTS.T, strict=True)), **SCALARS, "normal": DATA["velocity"]}
    lines = [
        "VERSION 0.7",
        "FIELDS " + " ".join(fields),
        "SIZE " + " ".join(str(v.dtype.itemsize) for v in fields.values()),
        "TYPE " + " ".join({"u": "U", "i": "I", "f": "F"}[v.dtype.kind] for v in fields.values()),
        "COUNT " + " ".join(str(v[0].size) for v in fields.values()),
        f"WIDTH {N}\nHEIGHT 1\nPOINTS {N}\nDATA {form}\n",
    ]
    head = "\n".join(lines).encode()
    if form == "ascii":
        rows = np.column_stack([v.astype(float) for v in fields.values()])
        path.write_bytes(head + b"".join(" ".join(map(repr, r)).encode() + b"\n" for r in rows.tolist()))
    elif form == "binary":
        table = np.zeros(N, [(k, v.dtype, v.shape[1:]) for k, v in fields.items()])
        for name, values in fields.items():
            table[name] = values
        path.write_bytes(head + table.tobytes())
    else:
        plain = b"".join(v.tobytes() for v in fields.values())
        literal = b"".join(
            bytes([len(c) - 1]) + c for c in (plain[k : k + 32] for k in range(0, len(plain), 32))
        )
        path.write_bytes(head + struct.pack("<II", len(literal), len(plain)) + literal)


def table(path, comma, head):
    columns = {
        **dict(zip("xyz", POINTS.T, strict=True)),
        "temperature": TEXT["temperature"],
        "big": TEXT["big"],
    }
    rows = zip(*[v.tolist() for v in columns.values()], strict=True)
    text = head + comma.join(columns) + "\n" + "".join(comma.join(map(repr, row)) + "\n" for row in rows)
    path.write_text(text)


TEXT = {"temperature": np.round(RANDOM.random(N), 3), "big": DATA["big"]}


def lammps(path):
    lines = [f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{N}\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1"]
    lines.append("ITEM: ATOMS big x y z temperature")
    rows = zip(TEXT["big"].tolist(), *POINTS.T.tolist(), TEXT["temperature"].tolist(), strict=True)
    path.write_text("\n".join([*lines, *(" ".join(map(repr, row)) for row in rows)]) + "\n")


def extended(path):
    rows = zip(TEXT["big"].tolist(), *POINTS.T.tolist(), TEXT["temperature"].tolist(), strict=True)
    head = f"{N}\nProperties=big:I:1:pos:R:3:temperature:R:1\n"
    path.write_text(head + "".join(" ".join(map(repr, row)) + "\n" for row in rows))


def las(path):
    header = laspy.LasHeader(point_format=3, version="1.4")
    header.scales = [1 / 256] * 3
    header.add_extra_dim(laspy.ExtraBytesParams("temperature", np.float32))
    header.add_extra_dim(laspy.ExtraBytesParams("velocity", "3f8"))
    scan = laspy.LasData(header)
    scan.xyz = POINTS
    scan.classification, scan.intensity = DATA["class"], np.arange(N, dtype=np.uint16) * 7
    scan["temperature"], scan["velocity"] = DATA["temperature"], DATA["velocity"]
    scan.write(str(path))


LAS = {
    "temperature": DATA["temperature"], "classification": DATA["class"], "velocity": DATA["velocity"],
    "intensity": np.arange(N, dtype=np.uint16) * 7,
}  # fmt: skip
WRITERS = {
    "binary.vtp": (lambda path: cloud().save(path), DATA),
    "text.vtp": (lambda path: cloud().save(path, binary=False), DATA),
    "binary.vtu": (lambda path: cloud().cast_to_unstructured_grid().save(path), DATA),
    "binary.vtk": (lambda path: cloud().save(path), DATA),
    "text.vtk": (lambda path: cloud().save(path, binary=False), DATA),
    "meshio.vtu": (lambda path: meshio.Mesh(POINTS, [("vertex", [[0]])], DATA).write(path), DATA),
    "text.ply": (lambda path: ply(path, "ascii"), SCALARS),
    "little.ply": (lambda path: ply(path, "binary_little_endian"), SCALARS),
    "big.ply": (lambda path: ply(path, "binary_big_endian"), SCALARS),
    "arrays.npz": (lambda path: np.savez(path, points=POINTS, **DATA), DATA),
    "table.npy": (lambda path: np.save(path, structured()), DATA),
    "text.pcd": (lambda path: pcd(path, "ascii"), {**SCALARS, "normal": DATA["velocity"]}),
    "binary.pcd": (lambda path: pcd(path, "binary"), {**SCALARS, "normal": DATA["velocity"]}),
    "packed.pcd": (lambda path: pcd(path, "binary_compressed"), {**SCALARS, "normal": DATA["velocity"]}),
    "table.csv": (lambda path: table(path, ",", ""), TEXT),
    "table.tsv": (lambda path: table(path, "\t", ""), TEXT),
    "table.txt": (lambda path: table(path, " ", "# "), TEXT),
    "table.xyz": (lambda path: table(path, " ", "# "), TEXT),
    "table.asc": (lambda path: table(path, " ", "# "), TEXT),
    "table.pts": (lambda path: table(path, " ", "# "), TEXT),
    "extended.xyz": (extended, TEXT),
    "atoms.dump": (lammps, TEXT),
    "scan.las": (las, LAS),
    "scan.laz": (las, LAS),
}  # fmt: skip


def check(found, expected, *, types=True):
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values)
        if types:
            assert found[name].dtype == values.dtype, name

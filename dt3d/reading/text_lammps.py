"""Atoms of LAMMPS dumps as text."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .point_data import PointData
from .text_lines import Lines, content, read_lines, shown, shown_names
from .text_numbers import numbers
from .text_values import keep_columns

_COUNT = re.compile(r"[0-9]{1,18}")


def read_lammps(path: Path, keep: PointData | None = None) -> np.ndarray:
    """The positions of the atoms of one time step: columns x, y, z, or unwrapped xu, yu, zu.

    A dump of two dimensions has no column z. ``keep`` gets the other columns.

    Returns
    -------
    float64 (n, 3) or (n, 2)

    Raises
    ------
    ValueError
        If there is more than one time step, the number of atoms disagrees with the lines, or positions are
        only there as fractions of the box (xs, ys, zs).
    """
    lines = content(read_lines(path), ())
    items = [k for k, line in enumerate(lines.text) if line.startswith("ITEM:")]
    if not items or items[0] != 0:
        msg = f"{path} is not a LAMMPS dump, which starts with 'ITEM:'"
        raise ValueError(msg)
    sections = [lines[a:b] for a, b in zip(items, [*items[1:], len(lines)], strict=True)]
    atoms = [section for section in sections if section.text[0].startswith("ITEM: ATOMS")]
    counts = [section for section in sections if section.text[0].startswith("ITEM: NUMBER OF ATOMS")]
    if len(atoms) != 1 or len(counts) != 1:
        msg = f"{path} should have one time step; found {len(atoms)} with atoms, {len(counts)} with numbers"
        raise ValueError(msg)
    promise = counts[0].text[1].strip() if len(counts[0]) > 1 else ""
    rows = atoms[0][1:]
    if not _COUNT.fullmatch(promise) or int(promise) != len(rows) or not len(rows):
        msg = f"{shown(promise)} atoms are promised, but {len(rows)} follow"
        raise counts[0].error(0, msg)
    return _positions(atoms[0], rows, keep)


def _positions(header: Lines, rows: Lines, keep: PointData | None) -> np.ndarray:
    names = header.text[0].split()[2:]
    for axes in (["x", "y", "z"], ["xu", "yu", "zu"], ["x", "y"], ["xu", "yu"]):
        if all(names.count(axis) == 1 for axis in axes):
            columns = [names.index(axis) for axis in axes]
            found = numbers(rows, None, columns, len(names))
            if keep is not None:
                keep_columns(rows, None, names, columns, ".", keep)
            return found
    msg = f"found columns {shown_names(names)}; expected x, y and z, as 'dump custom ... x y z' writes them"
    raise header.error(0, msg)

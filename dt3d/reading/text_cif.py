"""Atoms of CIF files, those of proteins (mmCIF) and those of small molecules, by Gemmi."""

from __future__ import annotations

import math
import re
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from .._optional import optional
from .text_cells import number
from .text_lines import read_text

if TYPE_CHECKING:
    from gemmi import cif

_UNCERTAINTY = re.compile(r"\([0-9]+\)$")


def read_cif(path: Path) -> np.ndarray:
    """The atoms of a file as they are listed, in ångström.

    Cartesian coordinates are taken as they are; fractions of the unit cell are multiplied by it. Symmetry is
    not applied: a small molecule's file has the asymmetric unit. All models of a protein are read.

    Returns
    -------
    float64 (n, 3)

    Raises
    ------
    ValueError
        If the file is not CIF, holds no atoms or more than one structure, or a coordinate is missing.
    ImportError
        If Gemmi is not installed.
    """
    gemmi = optional("gemmi", "this file")
    text = read_text(path)
    try:
        document = gemmi.cif.read_string(text)
    except (ValueError, RuntimeError) as error:
        msg = f"{path} is not a CIF file: {error}"
        raise ValueError(msg) from error
    found = [(block, *tags) for block in document for tags in [_tags(block)] if tags]
    if len(found) != 1:
        msg = f"{path} holds {len(found) or 'no'} structures with atoms; expected one"
        raise ValueError(msg)
    block, tags, fractions = found[0]
    table = block.find(tags)
    if not len(table):
        msg = f"{path}: the columns {', '.join(tags)} are not there as a whole"
        raise ValueError(msg)
    points = np.empty((len(table), 3))
    for k, row in enumerate(table):
        for axis in range(3):
            try:
                points[k, axis] = number(_UNCERTAINTY.sub("", row[axis]))
            except ValueError as error:
                msg = f"{path}: {tags[axis]} of atom {k + 1}: {error}"
                raise ValueError(msg) from None
    return _cartesian(path, gemmi, block, points) if fractions else points


def _tags(block: cif.Block) -> tuple[list[str], bool] | None:
    """The names of the coordinates in a block, and whether they are fractions of the cell."""
    for prefix, fractions in [
        ("_atom_site.Cartn_", False),
        ("_atom_site_Cartn_", False),
        ("_atom_site.fract_", True),
        ("_atom_site_fract_", True),
    ]:
        if block.find_loop(f"{prefix}x") or block.find_value(f"{prefix}x"):
            return [f"{prefix}{axis}" for axis in "xyz"], fractions
    return None


def _cartesian(path: Path, gemmi: ModuleType, block: cif.Block, fractions: np.ndarray) -> np.ndarray:
    separator = "." if block.find_value("_cell.length_a") else "_"
    names = [f"_cell{separator}{name}" for name in ("length_a", "length_b", "length_c")]
    names += [f"_cell{separator}angle_{name}" for name in ("alpha", "beta", "gamma")]
    sizes = [gemmi.cif.as_number(block.find_value(name) or "?") for name in names]
    for name, size in zip(names, sizes, strict=True):
        if not math.isfinite(size) or size <= 0:
            msg = f"{path} has fractions of the unit cell, but its {name} is missing or not a size"
            raise ValueError(msg)
    cell = gemmi.UnitCell(*sizes)
    cartesian: np.ndarray = fractions @ np.array(cell.orth.mat.tolist()).T
    return cartesian

"""Atoms of Protein Data Bank files, and of what programs write that is nearly such a file."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .text_lines import Lines, read_lines, shown

LONGEST_LINE = 1000
"""Characters; the format has 80, and a search for coordinates takes the square of a line's length."""

FIELDS = [slice(30, 38), slice(38, 46), slice(46, 54)]
"""x, y and z: columns 31 to 54 (wwPDB format 3.3, section "ATOM")."""

_NO_ATOMS = """
    HEADER OBSLTE TITLE SPLIT CAVEAT COMPND SOURCE KEYWDS EXPDTA NUMMDL MDLTYP AUTHOR REVDAT SPRSDE JRNL
    REMARK DBREF DBREF1 DBREF2 SEQADV SEQRES MODRES HET HETNAM HETSYN FORMUL HELIX SHEET TURN SSBOND LINK
    LINKR CISPEP SITE CRYST1 ORIGX1 ORIGX2 ORIGX3 SCALE1 SCALE2 SCALE3 MTRIX1 MTRIX2 MTRIX3 TVECT MODEL
    ANISOU SIGATM SIGUIJ TER ENDMDL CONECT MASTER END FTNOTE HYDBND SLTBRG USER BREAK ROOT ENDROO BRANCH
    ENDBRA TORSDO
"""
RECORDS = set(_NO_ATOMS.split())
"""The records that are no atoms: of all versions of the format, and of refinement and docking programs."""

_FIELD = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+|nan|inf)", re.ASCII | re.IGNORECASE)
# a coordinate is written with three decimals, so even numbers that touch can be told apart
_COORDINATE = r"\s*(-?[0-9]+\.[0-9]{3})"
_THREE = re.compile(rf"(?<![0-9.\-]){_COORDINATE}{_COORDINATE}{_COORDINATE}(?![0-9])", re.ASCII)
_ATOM = re.compile(r"ATOM|HETATM", re.IGNORECASE)
_SECOND_ATOM = re.compile(r"(?:ATOM|HETATM)\s*\w+\s", re.IGNORECASE)
_ATOM_WITHIN = re.compile(
    rf"(?:ATOM|HETATM)\s*\w+\s.*?[ 0-9]{_COORDINATE}{_COORDINATE}{_COORDINATE}", re.IGNORECASE
)


def read_pdb(path: Path) -> np.ndarray:
    """The atoms of a file: ATOM and HETATM records of all models.

    Coordinates are read from columns 31 to 54, or from beside them where a serial number of more than five
    digits has shifted the rest of the line. What serial numbers are (decimal, hexadecimal, hybrid-36) does
    not matter, nor does the case of letters.

    Returns
    -------
    float64 (n, 3)
        In ångström.

    Raises
    ------
    ValueError
        If there are no atoms, the coordinates of one are not understood, or a line among the atoms is no
        record of the format: it could be a damaged atom. The message names the line.
    """
    lines = read_lines(path)
    atoms = [k for k, line in enumerate(lines.text) if _ATOM.match(line)]
    if not atoms:
        msg = f"{path} holds no ATOM or HETATM records"
        raise ValueError(msg)
    points = np.empty((len(atoms), 3))
    row = 0
    for k, line in enumerate(lines.text):
        if len(line) > LONGEST_LINE:
            msg = f"{len(line)} characters, while a record has 80"
            raise lines.error(k, msg)
        if row < len(atoms) and k == atoms[row]:
            points[row] = _coordinates(lines, k)
            row += 1
        else:
            _check_other(lines, k, line, atoms[0] < k < atoms[-1])
    return points


def _coordinates(lines: Lines, k: int) -> list[float]:
    line = lines.text[k]
    if line[34:35] == line[42:43] == line[50:51] == "." or len(line) < 54:
        found = [line[field].strip() for field in FIELDS]
        if len(line) < 54 or not all(map(_FIELD.fullmatch, found)) or line[54:55].isdigit():
            found = []
    elif shifted := _THREE.search(line, 26):
        found = list(shifted.groups())
    else:
        # another precision, which is believed if blanks or the line's end stand around the columns
        found = [line[field].strip() for field in FIELDS]
        if not all(map(_FIELD.fullmatch, found)) or line[29] != " " or line[54:55] not in ("", " "):
            found = []
    if not found:
        msg = f"an atom's coordinates (columns 31 to 54) are not numbers: {shown(line[26:66])}"
        raise lines.error(k, msg)
    if second := _SECOND_ATOM.search(line, 54):
        msg = f"a second atom on the line: {shown(line[second.start() :])}"
        raise lines.error(k, msg, second.start() + 1)
    return [float(cell) for cell in found]


def _check_other(lines: Lines, k: int, line: str, among_atoms: bool) -> None:
    """Raise a ValueError for a line that may be a damaged atom.

    That is one with an atom further right, and among the atoms each line that is no record. Before and behind
    them, where programs write tables of their own, it is one with coordinates like those of an atom.
    """
    within = _ATOM.match(line.lstrip()) or _ATOM_WITHIN.search(line)
    # atoms that someone has turned into a remark fit on a line
    if within and not (len(line) <= 80 and line.startswith(("REMARK", "#", "!"))):
        msg = f"an atom that does not start where the line starts: {shown(line)}"
        raise lines.error(k, msg)
    name = line[:6].strip().upper()
    # REMARK and others may touch what follows
    if not name or name in RECORDS or name.split()[0] in RECORDS or line.startswith(("#", "!")):
        return
    points = (line[34:35], line[42:43], line[50:51])
    if among_atoms or points.count(".") >= 2 or _THREE.search(line):
        msg = f"{shown(line[:6].rstrip())} is not a record of a PDB file; it may be a damaged atom"
        raise lines.error(k, msg, 1)

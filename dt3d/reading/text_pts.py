"""Points of .pts files: those of laser scanners (Leica), and landmarks in pictures (iBUG)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .point_data import PointData
from .text_columns import columns_of
from .text_lines import Lines, content, read_lines, shown

_COUNT = re.compile(r"[0-9]{1,18}")
_LANDMARKS = re.compile(r"n_points\s*:\s*([0-9]{1,18})", re.IGNORECASE)


def read_pts(path: Path, keep: PointData | None = None) -> np.ndarray:
    """The points of one or more scans, or landmarks.

    A scan is a line with the number of points, and as many lines ``x y z intensity r g b``, of which x, y
    and z are read; the number may be missing. Landmarks have ``version: 1``, ``n_points: n``, and ``x y`` per
    line in braces. ``keep`` gets columns that have names, in a comment.

    Returns
    -------
    float64 (n, 3) or (n, 2)

    Raises
    ------
    ValueError
        If a count and the number of points disagree, or rows are not like the first.
    """
    whole = read_lines(path)
    lines = content(whole)
    if not len(lines):
        msg = f"{path} is empty; expected points"
        raise ValueError(msg)
    if lines.text[0].lower().strip().startswith("version"):
        return _landmarks(lines)
    if not _COUNT.fullmatch(lines.text[0].strip()):
        return columns_of(whole, leading=True, keep=keep)  # with its comments, which may name columns
    scans, at = [], 0
    if keep is not None and len(lines) > 1 and (width := len(lines.text[1].split())) > 3:
        keep.leave_out(f"columns 4 to {width}", "they have no names")
    while at < len(lines):
        if not _COUNT.fullmatch(lines.text[at].strip()):
            msg = f"{shown(lines.text[at])}: more points than promised"
            raise lines.error(at, msg)
        count = int(lines.text[at])
        scan = lines[at + 1 : at + 1 + count]
        if len(scan) != count:
            msg = f"{count} points are promised, but {len(scan)} follow"
            raise lines.error(at, msg)
        if count:
            scans.append(columns_of(scan, leading=True))
        at += 1 + count
    if not scans:
        msg = f"{path} holds no points"
        raise ValueError(msg)
    if len({scan.shape[1] for scan in scans}) > 1:
        msg = f"{path}: scans of two and of three coordinates"
        raise ValueError(msg)
    return np.concatenate(scans)


def _landmarks(lines: Lines) -> np.ndarray:
    text = [line.strip() for line in lines.text]
    promise = _LANDMARKS.fullmatch(text[1]) if len(text) > 1 else None
    if not promise or len(text) < 5 or text[2] != "{" or text[-1] != "}":
        msg = f"{lines.path} should have 'version: 1', 'n_points: n', and points in braces"
        raise ValueError(msg)
    rows = lines[3:-1]
    if int(promise[1]) != len(rows):
        msg = f"{promise[1]} points are promised, but {len(rows)} are in braces"
        raise lines.error(1, msg)
    return columns_of(rows)

"""The points of laser scans, .las and .laz, by laspy."""

from __future__ import annotations

import logging
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .._optional import optional
from .child import read_in_child
from .point_data import PointData

PLACES = ("X", "Y", "Z")
"""The dimensions that are the points themselves, as integers."""

WITH_WAVES = (4, 5, 9, 10)
"""Point formats after which a file may have wave packets."""


def read_las(path: Path, keep: PointData | None = None) -> np.ndarray:
    """All points in the coordinates of the file's reference system, float64 (n, 3).

    Each is an integer times a scale plus an offset, which the header has. ``keep`` gets the other dimensions.

    Raises
    ------
    ValueError
        If the file is damaged, or has not the number of points that the header promises.
    ImportError
        If laspy, or for .laz its part lazrs, is not installed.
    """
    laspy = optional("laspy", "this file")
    _check_records(path)
    with _silent("laspy"), laspy.open(path) as file:
        header = file.header
        promised, size = header.point_count, path.stat().st_size
        packed = header.are_points_compressed
        if not packed and header.offset_to_point_data + promised * header.point_format.size > size:
            msg = f"{path} is cut off: {promised} points are promised, more than its {size} bytes hold"
            raise ValueError(msg)
        if not packed and not header.number_of_evlrs and header.point_format.id not in WITH_WAVES:
            left = size - header.offset_to_point_data - promised * header.point_format.size
            if left >= header.point_format.size:
                msg = f"{path} is damaged: {left} bytes follow the {promised} points that are promised"
                raise ValueError(msg)
        points = np.empty((0, 3))
        if not packed:
            scan = file.read()
            points = np.array(scan.xyz, np.float64)
            if keep is not None:
                for name in header.point_format.dimension_names:
                    if name not in PLACES:
                        keep.add(name, np.asarray(scan[name]))
    if packed:
        optional("lazrs", "this file")
        # lazrs panics, which prints and can end the process, where packed points are damaged
        return read_in_child("laz_child.py", path, keep)
    if len(points) != promised or not promised:
        msg = f"{path} holds {len(points)} points; its header promises {promised}"
        raise ValueError(msg)
    return points


def _check_records(path: Path) -> None:
    """Raise a ValueError unless the records of variable length can lie where the header has them.

    laspy reads as many as are promised, billions at the end of the file, too. Source: "LAS Specification
    1.4", table "Public Header Block".
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(247)
    if head[:4] != b"LASF" or len(head) < 227:
        msg = f"{path} is no LAS file: it should start with LASF and a header of 227 bytes"
        raise ValueError(msg)
    length, first, before = struct.unpack_from("<HII", head, 94)
    later = struct.unpack_from("<I", head, 243)[0] if head[25] >= 4 and len(head) == 247 else 0
    if not (length <= first <= size and 54 * before <= first and 60 * later <= size):
        msg = f"{path} is damaged: {before} records before its points and {later} after them do not fit"
        raise ValueError(msg)


@contextmanager
def _silent(name: str) -> Iterator[None]:
    """A library that logs what it also raises is not heard."""
    logger = logging.getLogger(name)
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(level)

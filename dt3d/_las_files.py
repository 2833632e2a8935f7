"""The points of laser scans, .las and .laz, by laspy."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ._paths import import_for_format


def read_las(path: Path) -> np.ndarray:
    """All points in the coordinates of the file's reference system, float64 (n, 3).

    Each is an integer times a scale plus an offset, which the header has.

    Raises
    ------
    ValueError
        If the file is damaged, or has not the number of points that the header promises.
    ImportError
        If laspy, or for .laz its part lazrs, is not installed.
    """
    laspy = import_for_format("laspy")
    with _silent("laspy"), laspy.open(path) as file:
        header = file.header
        promised, size = header.point_count, path.stat().st_size
        if header.are_points_compressed:
            import_for_format("lazrs")
        elif header.offset_to_point_data + promised * header.point_format.size > size:
            msg = f"{path} is cut off: {promised} points are promised, more than its {size} bytes hold"
            raise ValueError(msg)
        points = np.array(file.read().xyz, np.float64)
    if len(points) != promised or not promised:
        msg = f"{path} holds {len(points)} points; its header promises {promised}"
        raise ValueError(msg)
    return points


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

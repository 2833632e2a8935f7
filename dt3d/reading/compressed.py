"""Files that gzip has packed: unpacked into a temporary folder, whatever format is inside."""

from __future__ import annotations

import gzip
import shutil
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .._memory import available_memory, gigabytes

CHUNK = 1 << 20


def is_packed(path: Path) -> bool:
    """Whether the last extension is .gz."""
    return path.suffix.lower() == ".gz"


def inner(path: Path) -> Path:
    """The name inside: ``a.csv`` of ``a.csv.gz``, and the name itself of all others."""
    return path.with_suffix("") if is_packed(path) else path


@contextmanager
def unpacked(path: Path) -> Iterator[Path]:
    """The file itself, or an unpacked copy of an .gz that lives as long as the context.

    Raises
    ------
    ValueError
        If the packed data are cut off or damaged, or unpack to more than memory or the disk would hold: a few
        kilobytes can stand for gigabytes.
    """
    if not is_packed(path):
        yield path
        return
    with tempfile.TemporaryDirectory(prefix="dt3d-") as folder:
        # what is read needs as much memory again
        most = min(available_memory() // 2, shutil.disk_usage(folder).free // 2)
        copy = Path(folder) / inner(path).name
        try:
            with gzip.open(path) as packed, copy.open("wb") as plain:
                size = 0
                while block := packed.read(CHUNK):
                    size += len(block)
                    if size > most:
                        msg = f"{path} unpacks to more than the {gigabytes(most)} that there is room for"
                        raise ValueError(msg)
                    plain.write(block)
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            msg = f"{path} is no whole gzip file: {error}"
            raise ValueError(msg) from error
        yield copy

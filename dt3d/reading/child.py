"""Reading in a process of its own, for a library that ends the process or prints where a file is damaged.

The child is a plain script, of which nothing of dt3d need be imported, so it starts in a fifth of a second.
It may take so much memory and time and no more, and leaves its array in a folder.
"""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import tempfile
from importlib import resources
from pathlib import Path

import numpy as np

from .._memory import available_memory, gigabytes
from .point_data import PointData

SECONDS, BYTES_PER_SECOND = 60, 1e6
"""Of processor time for a file of any size, and one second more for each so many bytes."""

ADDRESSES = 2 << 30
"""Bytes of address space for the interpreter, its libraries and their threads."""

OUT_OF_TIME = -getattr(signal, "SIGXCPU", 24)
"""The status of a child that the system has ended because its seconds were over."""


def read_in_child(script: str, path: Path, keep: PointData | None = None) -> np.ndarray:
    """The array that a script of this package reads from the file.

    Parameters
    ----------
    script : str
        Its name. It is called with the path, a folder, `sys.path` as JSON, bytes and seconds, and "data" or
        "none". It leaves array.npy in the folder, or report.json, which is what is wrong with the file; and
        with "data" data.npz: "names", and their arrays as "0", "1" ...
    path : Path
        The file.
    keep : PointData, optional
        Gets the arrays of data.npz.

    Raises
    ------
    ValueError
        If the child reports something, takes too long, or ends itself.
    OSError
        If no process can be started.
    """
    room = available_memory()
    seconds = int(SECONDS + path.stat().st_size / BYTES_PER_SECOND)
    source = (resources.files(__package__) / script).read_text(encoding="utf-8")
    if not sys.executable:
        msg = f"{path} is read in a process of its own, and this Python does not know its executable"
        raise OSError(msg)
    with tempfile.TemporaryDirectory(prefix="dt3d-") as folder:
        limits = [json.dumps(sys.path), str(room + ADDRESSES), str(seconds)]
        limits.append("none" if keep is None else "data")
        command = [sys.executable, "-P", "-W", "ignore", "-c", source, str(path.absolute()), folder, *limits]
        none = subprocess.DEVNULL
        try:
            # the wall may show more than the processor where many wait for it
            done = subprocess.run(command, stdin=none, stdout=none, stderr=none, timeout=20 * seconds)
            status = done.returncode
        except subprocess.TimeoutExpired:
            status = OUT_OF_TIME
        report, array = Path(folder) / "report.json", Path(folder) / "array.npy"
        if report.exists():
            msg = f"{path} {json.loads(report.read_text(encoding='utf-8'))}"
            raise ValueError(msg)
        if status == OUT_OF_TIME:
            msg = f"{path} could not be read within {seconds} s; it may be damaged"
            raise ValueError(msg)
        if status or not array.exists():
            # a library that gets no memory may end its process
            need = f"more memory than the {gigabytes(room)} that are available"
            msg = f"{path} is damaged, or needs {need}: what reads it ended with status {status}"
            raise ValueError(msg)
        if keep is not None:
            with np.load(Path(folder) / "data.npz") as data:
                for k, name in enumerate(data["names"].tolist()):
                    keep.add(name, data[str(k)])
        return np.asarray(np.load(array))

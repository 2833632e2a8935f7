"""A script, run by `child`: the points of a .laz file and their data, in a process that lazrs may end."""

from __future__ import annotations

import json
import os
import sys
from typing import Any


def main(path: str, folder: str, search: str, memory: str, seconds: str, data: str) -> None:
    """Write the points of ``path`` to array.npy in the folder, or what is wrong with it to report.json.

    If ``data`` is "data", their other dimensions go to data.npz.
    """
    limit(int(memory), int(seconds))
    sys.path[:] = json.loads(search)
    import laspy
    import numpy as np

    try:
        with laspy.open(path) as file:
            promised = file.header.point_count
            scan = file.read()
            points = np.array(scan.xyz, np.float64)
            names = [name for name in scan.point_format.dimension_names if name not in ("X", "Y", "Z")]
        if len(points) != promised or not promised:
            msg = f"holds {len(points)} points; its header promises {promised}"
            raise ValueError(msg)
        if data == "data":
            # names that are numbers: those of the file may be anything
            arrays: dict[str, Any] = {str(k): np.asarray(scan[name]) for k, name in enumerate(names)}
            np.savez(os.path.join(folder, "data.npz"), names=np.array(names, np.str_), **arrays)
        np.save(os.path.join(folder, "array.npy"), points)
    except BaseException as error:  # a panic of Rust is no Exception
        with open(os.path.join(folder, "report.json"), "w", encoding="utf-8") as report:
            json.dump(f"could not be read by laspy: {type(error).__name__}: {error}", report)


def limit(memory: int, seconds: int) -> None:
    """End this process rather than the machine, where a header lies."""
    try:
        import resource
    except ImportError:  # Windows
        return
    most = {resource.RLIMIT_AS: memory, resource.RLIMIT_CPU: seconds, resource.RLIMIT_CORE: 0}
    for what, value in most.items():
        hard = resource.getrlimit(what)[1]
        if hard == resource.RLIM_INFINITY or value < hard:
            try:
                resource.setrlimit(what, (value, hard))
            except (OSError, ValueError):  # macOS knows no limit of address space
                continue


if __name__ == "__main__":
    main(*sys.argv[1:])

"""A script, run by `child`: the points of a .laz file, in a process that lazrs may end."""

from __future__ import annotations

import json
import os
import sys


def main(path: str, folder: str, search: str, memory: str, seconds: str) -> None:
    """Write the points of ``path`` to array.npy in the folder, or what is wrong with it to report.json."""
    limit(int(memory), int(seconds))
    sys.path[:] = json.loads(search)
    import laspy
    import numpy as np

    try:
        with laspy.open(path) as file:
            promised = file.header.point_count
            points = np.array(file.read().xyz, np.float64)
        if len(points) != promised or not promised:
            msg = f"holds {len(points)} points; its header promises {promised}"
            raise ValueError(msg)
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

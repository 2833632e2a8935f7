"""Two networks of processors, in unit steps: a link carries one message a step.

F. T. Leighton, Introduction to Parallel Algorithms and Architectures: Arrays, Trees, Hypercubes, Morgan
Kaufmann 1992: diameters, bisections, and prefix sums on both (sections 1.2, 1.7, 3.1-3.4). Routing with
random intermediate stops takes time of the order of the diameter plus the busiest processor's messages on a
hypercube (L. G. Valiant, SIAM Journal on Computing 11, 1982, 350-361).
"""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, sqrt

from .._ledger.entry import Entry
from .model import Model, depth_of_tree, used_processors
from .pram import STEP, local_scan, scan_model


def _hypercube(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    if entry.primitive == "scan":
        across = depth_of_tree(used_processors(entry))  # one exchange along each dimension
        return c["step"] * entry.operations * (local_scan(entry) + across)
    travel = depth_of_tree(processors) + entry.busiest if entry.messages else 0
    return scan_model(entry, processors, c) + c["step"] * travel


def _mesh(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    side = ceil(sqrt(processors))
    if entry.primitive == "scan":
        # along the rows, down the last column, and back along the rows
        across = 3 * ceil(sqrt(used_processors(entry))) if used_processors(entry) > 1 else 0
        return c["step"] * entry.operations * (local_scan(entry) + across)
    if not entry.messages:
        return scan_model(entry, processors, c)
    # half of the messages to places all over the mesh cross its middle, where `side` links lead each way
    through_the_middle = ceil(entry.messages / 4 / side)
    travel = 2 * (side - 1) + max(entry.busiest, through_the_middle)
    return scan_model(entry, processors, c) + c["step"] * travel


HYPERCUBE = Model(
    "HYPERCUBE",
    "unit steps; a scan is one exchange a dimension; messages take log2(P) and the busiest processor's load",
    _hypercube,
    {"step": STEP},
)

MESH2D = Model(
    "MESH2D",
    "unit steps; a scan is three sweeps of a side; messages take the diameter, and the busiest processor's "
    "load or a quarter of all over the links in the middle (as of random places; not measured)",
    _mesh,
    {"step": STEP},
)

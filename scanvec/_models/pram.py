"""Abstract machines that count unit steps: two PRAMs, and the scan model.

What they have in common: an elementary operation, or an access to memory, takes one step for each virtual
processor. They differ in what a scan across processors and a concurrent access cost.

* G. E. Blelloch, Scans as Primitive Parallel Operations, IEEE Transactions on Computers 38, 1989, 1526-1538:
  the scan model, and what a scan costs without it: a tree over the processors, up and down.
* G. E. Blelloch, Vector Models for Data-Parallel Computing, MIT Press 1990, chapter 3: long vectors, in
  which a processor first combines its own elements, and afterwards adds what comes from the others.
* J. JaJa, An Introduction to Parallel Algorithms, Addison-Wesley 1992, chapter 10: an EREW PRAM carries out a
  concurrent access by sorting, in O(log P) steps.
"""

from __future__ import annotations

from collections.abc import Mapping

from .._ledger.entry import Entry
from .model import CONVENTION, Constant, Model, depth_of_tree, used_processors

STEP = Constant(
    1e-6, "s", CONVENTION, "one unit step; the times of abstract machines compare with each other only"
)


def local_scan(entry: Entry) -> int:
    """Steps of a scan within processors: a sweep for the total, and one that adds what comes in."""
    return 2 * entry.vp_ratio if entry.vp_ratio > 1 else 1


def scan_model(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    """Unit steps of the scan model."""
    if entry.primitive == "map":
        return c["step"] * entry.operations * entry.vp_ratio
    if entry.primitive == "scan":
        across = 1 if used_processors(entry) > 1 else 0
        return c["step"] * entry.operations * (local_scan(entry) + across)
    return c["step"] * entry.vp_ratio


def _crcw(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    if entry.primitive == "scan":
        across = 2 * depth_of_tree(used_processors(entry))
        return c["step"] * entry.operations * (local_scan(entry) + across)
    return scan_model(entry, processors, c)


def _erew(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    if entry.accesses > 1:  # a sort brings equal indices together, a copy-scan serves all
        return c["step"] * entry.vp_ratio * (1 + depth_of_tree(used_processors(entry)))
    return _crcw(entry, processors, c)


SCAN = Model(
    "SCAN",
    "unit steps; a scan across processors is one, as is a concurrent access (Blelloch 1989)",
    scan_model,
    {"step": STEP},
)

CRCW_PRAM = Model(
    "CRCW_PRAM",
    "unit steps; a concurrent access is one, a scan is a tree over the processors, up and down",
    _crcw,
    {"step": STEP},
)

EREW_PRAM = Model(
    "EREW_PRAM",
    "unit steps; a scan is a tree; a concurrent access is reported, and costs 1 + log2(P) as a sort would",
    _erew,
    {"step": STEP},
    exclusive=True,
)

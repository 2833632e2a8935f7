"""scanvec: Blelloch's scan-vector model on JAX.

Vectors live on a machine; operations on them are the model's: elementwise maps under a context, scans,
segmented scans, permutations, and what is composed from these. `Simulated` machines run them on P processors
and keep a ledger of every step; `Device` runs the same programs on whole vectors. Teng et al. 1993 describe
the model in section 2.3.

>>> import scanvec as sv
>>> cm = sv.Simulated(processors=4)
>>> v = cm.vector([5, 1, 3, 4, 3, 9, 2, 6])
>>> sv.scan(v, sv.ADD).to_numpy().tolist()
[0, 5, 6, 9, 13, 16, 25, 27]
>>> cm.ledger.steps
1

The book is G. E. Blelloch, Vector Models for Data-Parallel Computing, MIT Press 1990.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from . import _deprecated

if TYPE_CHECKING:
    # exclusive access
    from ._ledger.conflict import ConcurrentAccessError, Conflict

    # machines, vectors and ledgers
    from ._ledger.entry import Entry, Row
    from ._ledger.ledger import Ledger
    from ._machine.base import Machine
    from ._machine.device import Device
    from ._machine.simulated import Simulated

    # cost models, and their calibration
    from ._models.calibration import calibrate
    from ._models.connection_machines import CM2, CM5
    from ._models.model import Constant, Model
    from ._models.networks import HYPERCUBE, MESH2D
    from ._models.pram import CRCW_PRAM, EREW_PRAM, SCAN

    # operators
    from ._monoid import ADD, AND, ARGMIN, COPY, MAX, MIN, MUL, OR, Monoid

    # functions of elements
    from ._primitives.elementwise import elementwise

    # two records into one
    from ._primitives.merge import flag_merge, where

    # vectors of other lengths
    from ._primitives.pack import append, distribute, pack, pack_index, split

    # movement
    from ._primitives.permute import get, permute, scatter, send

    # scalars
    from ._primitives.scalar import extract, full_like, insert

    # scans and reductions
    from ._primitives.scan import (
        backscan,
        backscan_inclusive,
        copy_scan,
        enumerate,
        op_distribute,
        reduce,
        scan,
        scan_inclusive,
    )

    # sorting and sets
    from ._primitives.sort import rank, segmented_sort, sort, union, unique
    from ._segments import Segments
    from ._vector import Vector

__all__ = [
    "ADD", "AND", "ARGMIN", "COPY", "MAX", "MIN", "MUL", "OR",
    "CM2", "CM5", "CRCW_PRAM", "EREW_PRAM", "HYPERCUBE", "MESH2D", "SCAN",
    "ConcurrentAccessError", "Conflict", "Constant", "Device", "Entry", "Ledger", "Machine", "Model",
    "Monoid", "Row", "Segments", "Simulated", "Vector",
    "append", "backscan", "backscan_inclusive", "calibrate", "copy_scan", "distribute", "elementwise",
    "enumerate", "extract", "flag_merge", "full_like", "get", "insert", "op_distribute", "pack", "pack_index",
    "permute", "rank", "reduce", "scan", "scan_inclusive", "scatter", "segmented_sort", "send", "sort",
    "split", "union", "unique", "where",
]  # fmt: skip

_HOMES = {
    "_ledger.conflict": ["ConcurrentAccessError", "Conflict"],
    "_ledger.entry": ["Entry", "Row"],
    "_ledger.ledger": ["Ledger"],
    "_machine.base": ["Machine"],
    "_machine.device": ["Device"],
    "_machine.simulated": ["Simulated"],
    "_models.calibration": ["calibrate"],
    "_models.connection_machines": ["CM2", "CM5"],
    "_models.model": ["Constant", "Model"],
    "_models.networks": ["HYPERCUBE", "MESH2D"],
    "_models.pram": ["CRCW_PRAM", "EREW_PRAM", "SCAN"],
    "_monoid": ["ADD", "AND", "ARGMIN", "COPY", "MAX", "MIN", "MUL", "OR", "Monoid"],
    "_primitives.elementwise": ["elementwise"],
    "_primitives.merge": ["flag_merge", "where"],
    "_primitives.pack": ["append", "distribute", "pack", "pack_index", "split"],
    "_primitives.permute": ["get", "permute", "scatter", "send"],
    "_primitives.scalar": ["extract", "full_like", "insert"],
    "_primitives.scan": [
        "backscan",
        "backscan_inclusive",
        "copy_scan",
        "enumerate",
        "op_distribute",
        "reduce",
        "scan",
        "scan_inclusive",
    ],
    "_primitives.sort": ["rank", "segmented_sort", "sort", "union", "unique"],
    "_segments": ["Segments"],
    "_vector": ["Vector"],
}
_MODULES = {name: module for module, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> object:
    """Load a public name when it is first used, and with it JAX, so that dt3d can do without."""
    if name in _deprecated.NAMES:
        _deprecated.warn(name, _deprecated.NAMES[name])
        return getattr(import_module(__name__), _deprecated.NAMES[name])
    if name not in _MODULES:
        msg = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(msg)
    value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

"""scanvec: Blelloch's scan-vector model on JAX.

Vectors live on a machine; operations on them are the model's: elementwise maps under a context, scans,
segmented scans, permutations, and what is composed from these. `Simulated` machines run them on P processors
and keep a ledger of every step; `Device` runs the same programs on whole vectors.

>>> import scanvec as sv
>>> cm = sv.Simulated(processors=4)
>>> v = cm.vector([5, 1, 3, 4, 3, 9, 2, 6])
>>> sv.scan(v, sv.ADD).to_numpy().tolist()
[0, 5, 6, 9, 13, 16, 25, 27]
>>> cm.ledger.steps
1

G. E. Blelloch, Vector Models for Data-Parallel Computing, MIT Press 1990.
"""

from . import _deprecated

# cost models, and their calibration
from ._calibration import calibrate

# exclusive access
from ._conflict import ConcurrentAccessError, Conflict
from ._connection_machines import CM2, CM5

# machines, vectors and ledgers
from ._device import Device
from ._elementwise import elementwise
from ._entry import Entry, Row

# scalars
from ._front_end import extract, insert
from ._ledger import Ledger
from ._machine import Machine

# two records into one
from ._merge import flag_merge, where
from ._model import Constant, Model

# operators
from ._monoid import ADD, AND, ARGMIN, COPY, MAX, MIN, MUL, OR, Monoid

# movement
from ._move import append, distribute, full_like, get, pack, pack_index, permute, scatter, send, split
from ._networks import HYPERCUBE, MESH2D
from ._pram import CRCW_PRAM, EREW_PRAM, SCAN

# scans and reductions
from ._scan import (
    backscan,
    backscan_inclusive,
    copy_scan,
    enumerate,
    op_distribute,
    reduce,
    scan,
    scan_inclusive,
)
from ._segments import Segments
from ._simulated import Simulated

# sorting and sets
from ._sort import rank, segmented_sort, sort, union, unique
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


def __getattr__(name: str) -> object:
    if name in _deprecated.NAMES:
        _deprecated.warn(name, _deprecated.NAMES[name])
        return globals()[_deprecated.NAMES[name]]
    msg = f"module {__name__!r} has no attribute {name!r}"
    raise AttributeError(msg)

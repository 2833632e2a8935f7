"""The papers' tables and figures, made again, and more of the kind: ``dt3d experiment NAME``."""

from __future__ import annotations

from .balance import balance
from .figure2 import figure2
from .figure3 import figure3
from .machines import machines
from .primitives import primitives
from .table1 import table1
from .table2 import table2
from .table3 import table3

EXPERIMENTS = {
    "table1": table1,
    "table2": table2,
    "table3": table3,
    "figure2": figure2,
    "figure3": figure3,
    "balance": balance,
    "machines": machines,
    "primitives": primitives,
}

__all__ = [
    "EXPERIMENTS",
    "balance",
    "figure2",
    "figure3",
    "machines",
    "primitives",
    "table1",
    "table2",
    "table3",
]

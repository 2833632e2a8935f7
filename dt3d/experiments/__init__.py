"""The papers' tables and figures, made again: ``dt3d experiment NAME``."""

from __future__ import annotations

from .figure2 import figure2
from .figure3 import figure3
from .table1 import table1
from .table2 import table2
from .table3 import table3

EXPERIMENTS = {"table1": table1, "table2": table2, "table3": table3, "figure2": figure2, "figure3": figure3}

__all__ = ["EXPERIMENTS", "figure2", "figure3", "table1", "table2", "table3"]

"""The papers' tables and figures, made again: ``dt3d experiment NAME``."""

from __future__ import annotations

from .table1 import table1

EXPERIMENTS = {"table1": table1}

__all__ = ["EXPERIMENTS", "table1"]

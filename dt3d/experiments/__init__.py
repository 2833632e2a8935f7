"""The papers' tables and figures, made again: ``dt3d experiment NAME``."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from .table1 import table1


def _kohout(name: str, summary: str) -> Callable[..., Any]:
    """An experiment that loads when it is run: numba takes a second to load."""

    def run(*args: Any, **options: Any) -> Any:
        return getattr(import_module(".kohout", __package__), name)(*args, **options)

    run.__doc__ = summary
    return run


EXPERIMENTS: dict[str, Callable[..., Any]] = {
    "table1": table1,
    "kohout-phases": _kohout("phases", "Kohout et al. 2004, Figure 1: time by phase."),
    "kohout-queue": _kohout("queue", "Kohout et al. 2004, Table 1: the best length of the queue."),
    "kohout-batch": _kohout("batch", "Kohout et al. 2004, Figures 4 to 6: the batch method."),
    "kohout-circumcircle": _kohout("circumcircle", "Kohout et al. 2004, Figures 7 and 8: circum-circle."),
    "kohout-arc": _kohout("arc", "Kohout et al. 2004, Figures 9 to 11: points on an arc."),
    "kohout-subdivision": _kohout("subdivision", "Kohout et al. 2004, Figure 12, up to 16 elements."),
    "kohout-table4": _kohout("table4", "Kohout et al. 2004, Table 4: the methods compared."),
    "kohout-crater": _kohout("crater", "Kohout et al. 2004, Figure 13: the Crater Lake terrain."),
}

__all__ = ["EXPERIMENTS", "table1"]

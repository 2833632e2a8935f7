"""The papers' tables and figures, made again. The command line runs these; nothing else imports them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from importlib import import_module

from .balance import balance
from .figure2 import figure2
from .figure3 import figure3
from .machines import machines
from .primitives import primitives
from .table1 import table1
from .table2 import table2
from .table3 import table3


class _Later:
    """An experiment whose module loads when it is run, or asked for its options: numba takes a second."""

    def __init__(self, module: str, name: str, summary: str) -> None:
        self.module, self.name = module, name
        self.__doc__ = summary

    def __call__(self, *args: object, **options: object) -> object:
        return self._function()(*args, **options)

    @property
    def __signature__(self) -> inspect.Signature:
        return inspect.signature(self._function())

    def _function(self) -> Callable[..., object]:
        function: Callable[..., object] = getattr(import_module(self.module, __package__), self.name)
        return function


def _kohout(name: str, summary: str) -> Callable[..., object]:
    """An experiment on the plane."""
    return _Later(".kohout", name, summary)


def _question(module: str, summary: str) -> Callable[..., object]:
    """An experiment on what the papers leave open, in the function that is named as its module."""
    return _Later(f".questions.{module}", module, summary)


EXPERIMENTS: dict[str, Callable[..., object]] = {
    "table1": table1,
    "table2": table2,
    "table3": table3,
    "figure2": figure2,
    "figure3": figure3,
    "balance": balance,
    "machines": machines,
    "primitives": primitives,
    "depth": _question("depth", "Does the choice of first facets bound the depth? (Teng et al. 1993, 6)"),
    "seeds": _question("seeds", "How many first facets suit how many nodes? (Teng et al. 1993, 3)"),
    "degrees": _question("degrees", "How many tetrahedra meet in a site? (Teng et al. 1993, 6)"),
    "cell-size": _question(
        "cell_size", "Are 8 sites per cell, and warrants of 8, the balance? (Teng et al. 1993, 7)"
    ),
    "eta": _question("eta", "Which eta, in which precision? (Teng et al. 1993, 5.1)"),
    "cells": _question("cells", "Are cells opened over cells needed bounded? (Teng et al. 1993, 6)"),
    "weak-scaling": _question(
        "weak_scaling", "Does it matter that a scan is a primitive? (Teng et al. 1993, 6)"
    ),
    "gain": _question("gain", "Why do 256 nodes gain so little over 128? (Teng et al. 1993, Table 2)"),
    "kohout-phases": _kohout("phases", "Kohout et al. 2004, Figure 1: time by phase."),
    "kohout-queue": _kohout("queue", "Kohout et al. 2004, Table 1: the best length of the queue."),
    "kohout-batch": _kohout("batch", "Kohout et al. 2004, Figures 4 and 5, Table 2: the batch method."),
    "kohout-circumcircle": _kohout("circumcircle", "Kohout et al. 2004, Figure 7, Table 3: circum-circle."),
    "kohout-preset": _kohout("preset", "Kohout et al. 2004, Figures 6 and 8: five distributions."),
    "kohout-arc": _kohout("arc", "Kohout et al. 2004, Figures 9 to 11: points on an arc."),
    "kohout-subdivision": _kohout("subdivision", "Kohout et al. 2004, Figure 12, up to 64 elements."),
    "kohout-table4": _kohout("table4", "Kohout et al. 2004, Table 4: the methods compared."),
    "kohout-crater": _kohout("crater", "Kohout et al. 2004, Figure 13: Crater Lake in relief."),
    "kohout-wrong": _kohout(
        "wrong_triangles", "Kohout et al. 2004, section 3.4: how rare wrong triangles are."
    ),
    "kohout-helping": _kohout(
        "helping", "Kohout et al. 2004, section 3.3: when the reviewer's variant pays."
    ),
    "kohout-interleave": _kohout("interleaving", "Kohout et al. 2004, section 4.2: caches or latency."),
    "kohout-batch-end": _kohout("end_of_batch", "Kohout et al. 2004, section 4.2: where batch ends."),
    "kohout-costs": _kohout("measure_costs", "What virtual time counts with, measured here: a file."),
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

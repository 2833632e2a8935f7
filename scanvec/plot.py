"""Pictures of a ledger: where its time goes, and how evenly processors are loaded. They need matplotlib.

``import scanvec.plot`` by itself; scanvec does not load it. Each function draws into ``ax``, or into new axes
of a figure that needs no screen, and returns the axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._ledger.ledger import Ledger

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PRIMITIVES = ("map", "scan", "get", "send")
INSTALL = "pictures need matplotlib; install it with: pip install matplotlib"


def new_axes() -> Axes:
    """Axes of a new figure without a window; ``ax.figure.savefig(path)`` writes it.

    Raises ImportError, saying what to install, where matplotlib is missing.

    >>> new_axes().get_title()
    ''
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError(INSTALL) from error
    figure = Figure(figsize=(7, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    return figure.subplots()


def time_by_primitive(ledger: Ledger, ax: Axes | None = None) -> Axes:
    """A bar for each phase, of the predicted seconds of its maps, scans, gets and sends.

    Raises
    ------
    ValueError
        If the ledger has no model.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.CM5)
    >>> with cm.phase("begin"):
    ...     v = sv.scan(cm.iota(8), sv.ADD)
    >>> time_by_primitive(cm.ledger).get_title()
    'scanvec.CM5, 4 processors'
    """
    ledger.check_has_model()
    ax = new_axes() if ax is None else ax
    phases = list(ledger.by_phase())
    seconds = {(row.phase, row.primitive): row.seconds or 0.0 for row in ledger.table("phase", "primitive")}
    _stack(ax, phases, {p: [seconds.get((phase, p), 0.0) for phase in phases] for p in PRIMITIVES})
    ax.set(ylabel="predicted seconds", title=f"{ledger.model!r}, {ledger.processors:,} processors")
    ax.tick_params(axis="x", rotation=20)
    return ax


def time_by_iteration(ledger: Ledger, *phases: str, ax: Axes | None = None) -> Axes:
    """A bar for each iteration, that is visit to these phases, of the predicted seconds in each phase.

    Raises
    ------
    ValueError
        If the ledger has no model, or none of the phases.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.CM5)
    >>> with cm.phase("begin"):
    ...     v = sv.scan(cm.iota(8), sv.ADD)
    >>> time_by_iteration(cm.ledger, "begin").get_xlabel()
    'iteration'
    """
    ledger.check_has_model()
    rows = {phase: ledger.by_iteration(phase) for phase in phases}
    if not any(rows.values()):
        msg = (
            f"the ledger has no phase {' or '.join(map(repr, phases))}; it has {', '.join(ledger.by_phase())}"
        )
        raise ValueError(msg)
    ax = new_axes() if ax is None else ax
    longest = max(map(len, rows.values()))
    columns = {
        phase: [row.seconds or 0.0 for row in found] + [0.0] * (longest - len(found))
        for phase, found in rows.items()
    }
    _stack(ax, [str(k + 1) for k in range(longest)], columns)
    ax.set(xlabel="iteration", ylabel="predicted seconds")
    return ax


def load_balance(ledger: Ledger, *phases: str, ax: Axes | None = None) -> Axes:
    """Elements and messages of each processor in some phases (all if none is named), over their mean.

    A level line at 1 is perfect balance.

    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.CM5)
    >>> with cm.phase("begin"):
    ...     v = sv.scan(cm.iota(8), sv.ADD)
    >>> load_balance(cm.ledger, "begin").get_title()
    'begin'
    """
    ax = new_axes() if ax is None else ax
    named = phases or tuple(ledger.by_phase())
    held = sum((ledger.held(phase) for phase in named), np.zeros(ledger.processors, np.int64))
    nothing = np.zeros(ledger.processors, np.int64)
    handled = sum((ledger.handled.get(phase, nothing) for phase in named), nothing)
    for label, load in (("elements", held), ("messages", handled)):
        mean = load.mean()
        if mean:
            ax.step(np.arange(len(load)), load / mean, where="mid", label=f"{label}, {mean:,.0f} on average")
    ax.axhline(1, color="0.7", linewidth=0.8)
    ax.set(xlabel="processor", ylabel="load / mean", ylim=(0, None), title=" + ".join(phases))
    ax.legend()
    return ax


def _stack(ax: Axes, labels: list[str], columns: dict[str, list[float]]) -> None:
    bottom = np.zeros(len(labels))
    for name, values in columns.items():
        ax.bar(labels, values, bottom=bottom, label=name)
        bottom += values
    ax.legend()

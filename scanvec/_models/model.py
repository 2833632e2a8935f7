"""What a cost model is: constants, each with where it comes from, and a formula for a step's time.

The models themselves are in `pram`, `networks` and `connection_machines`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from .._ledger.entry import Entry

SOURCED, CALIBRATED, CONVENTION, ESTIMATE = "sourced", "calibrated", "convention", "estimate"


@dataclass(frozen=True)
class Constant:
    """A number of a model.

    Attributes
    ----------
    value : float
    unit : str
    origin : str
        "sourced" from a publication; "calibrated" to measured times; "convention", a unit that says nothing
        of a machine; or "estimate", derived from other figures as the source says.
    source : str
        Which publication, which times, or the derivation.

    Examples
    --------
    >>> import scanvec as sv
    >>> step = sv.SCAN.constants["step"]
    >>> step.value, step.unit, step.origin
    (1e-06, 's', 'convention')
    """

    value: float
    unit: str
    origin: str
    source: str


@dataclass(frozen=True)
class Model:
    """The time of every step on P processors, as a function of its measured loads.

    Attributes
    ----------
    name : str
    about : str
        The formula in words.
    cost : (Entry, processors, constants by name) -> float
        Seconds of one step.
    constants : mapping of str to Constant
    exclusive : bool
        Concurrent reads and writes are not allowed: a machine with this model counts accesses and reports
        those that are not exclusive.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
    >>> v = cm.iota(8) + 1
    >>> cm.ledger.seconds, cm.ledger.under(sv.MESH2D).seconds >= cm.ledger.seconds
    (4e-06, True)
    """

    name: str
    about: str
    cost: Callable[[Entry, int, Mapping[str, float]], float]
    constants: Mapping[str, Constant]
    exclusive: bool = False

    def seconds(self, entry: Entry, processors: int) -> float:
        """Predicted time of one step.

        >>> import scanvec as sv
        >>> step = sv.Entry("", "map", "map", elements=8, vp_ratio=2, messages=0, busiest=0, bytes=0)
        >>> sv.SCAN.seconds(step, processors=4)
        2e-06
        """
        return self.cost(entry, processors, self.values)

    @property
    def values(self) -> dict[str, float]:
        """The constants' values by name.

        >>> import scanvec as sv
        >>> sv.SCAN.values
        {'step': 1e-06}
        """
        return {name: c.value for name, c in self.constants.items()}

    def calibrated(self, source: str, **values: float) -> Model:
        """The model with other values of some constants, marked as calibrated to ``source``.

        Raises
        ------
        ValueError
            For a name that is no constant of the model.

        Examples
        --------
        >>> import scanvec as sv
        >>> sv.SCAN.calibrated("a stopwatch", step=2e-6).values
        {'step': 2e-06}
        """
        for name in values:
            if name not in self.constants:
                msg = f"{self.name} has no constant {name!r}; it has {', '.join(self.constants)}"
                raise ValueError(msg)
        changed = {
            name: replace(self.constants[name], value=value, origin=CALIBRATED, source=source)
            for name, value in values.items()
        }
        return replace(self, constants={**self.constants, **changed})

    def __repr__(self) -> str:
        return f"scanvec.{self.name}"

    def __str__(self) -> str:
        rows = [(n, f"{c.value:.4g} {c.unit}", c.origin, c.source) for n, c in self.constants.items()]
        widths = [max(len(r[k]) for r in rows) for k in range(3)]
        lines = ["  ".join([*(x.ljust(w) for x, w in zip(r, widths, strict=False)), r[3]]) for r in rows]
        return "\n".join([f"{self.name}: {self.about}", *("  " + line for line in lines)])


def check_model(model: object) -> Model | None:
    """The model, or None; ValueError for anything else."""
    if model is not None and not isinstance(model, Model):
        msg = f"model must be a scanvec model, such as scanvec.CM5, got {model!r}"
        raise ValueError(msg)
    return model


def used_processors(entry: Entry) -> int:
    """How many processors hold elements of the step's vector."""
    return max(1, -(-entry.elements // entry.vp_ratio))


def depth_of_tree(leaves: int) -> int:
    """ceil(log2(leaves)): levels of a balanced tree."""
    return max(0, (leaves - 1).bit_length())

"""Calibration: constants of a model from measured times of programs whose ledgers are known."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from .._ledger.ledger import Ledger
from .model import Model


def calibrate(
    model: Model, ledgers: Sequence[Ledger], seconds: Sequence[float], free: Sequence[str], source: str
) -> Model:
    """The model with those values of ``free`` constants that bring its predictions nearest to ``seconds``.

    Least squares of the relative errors, with no constant negative. The model's cost must be linear in the
    free constants.

    Parameters
    ----------
    model : Model
        Whose constants are fitted; it does not change.
    ledgers : sequence of Ledger
        What ran, one ledger for each time.
    seconds : sequence of float
        The measured times.
    free : sequence of str
        Names of at most eight constants; the others stay.
    source : str
        Where the times are from; it goes into the constants.

    Raises
    ------
    ValueError
        If there are fewer times than free constants, not one for each ledger, or a name is unknown.

    Examples
    --------
    >>> import scanvec as sv
    >>> ledger = sv.Ledger(processors=4)
    >>> ledger.record("map", elements=8, vp_ratio=2, messages=0, busiest=0, size=0)
    >>> model = sv.calibrate(sv.SCAN, [ledger], [1e-3], ["step"], "a stopwatch")
    >>> print(model.constants["step"].origin, round(model.values["step"], 9))
    calibrated 0.0005
    """
    if len(seconds) != len(ledgers) or len(seconds) < len(free):
        msg = (
            f"calibrate: {len(ledgers)} ledgers, {len(seconds)} times and {len(free)} free constants; there "
            f"must be a time for each ledger, and no fewer than free constants"
        )
        raise ValueError(msg)
    times = np.asarray(seconds, float)
    nothing = dict.fromkeys(free, 0.0)
    fixed = _predictions(model.calibrated(source, **nothing), ledgers)
    units = [model.calibrated(source, **(nothing | {name: 1.0})) for name in free]
    columns = [_predictions(unit, ledgers) - fixed for unit in units]
    values = _least_squares(np.column_stack(columns) / times[:, None], 1 - fixed / times)
    return model.calibrated(source, **dict(zip(free, values.tolist(), strict=True)))


def _predictions(model: Model, ledgers: Sequence[Ledger]) -> np.ndarray:
    return np.array([ledger.under(model).seconds for ledger in ledgers])


def _least_squares(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """x >= 0 with least |a x - b|: the best of the solutions on all sets of columns that are not negative."""
    columns = range(a.shape[1])
    best, least = np.zeros(a.shape[1]), float(b @ b)
    for size in range(1, a.shape[1] + 1):
        for chosen in map(list, combinations(columns, size)):
            x, *_ = np.linalg.lstsq(a[:, chosen], b, rcond=None)
            error = float(np.sum((a[:, chosen] @ x - b) ** 2))
            if (x >= 0).all() and error < least:
                least = error
                best = np.zeros(a.shape[1])
                best[chosen] = x
    return best

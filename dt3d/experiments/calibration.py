"""The CM-5 model's calibration: its two constants without a source, from Table 1's random sets.

What an operation on an element costs cannot be told from Table 1: with anything from 0 to 2 microseconds, in
place of the model's estimate, the times are met equally well, as elements grow like those that are moved.
"""

from __future__ import annotations

from collections.abc import Mapping

import scanvec as sv

from .paper import PROCESSORS, RANDOM

# what the C* system costs: a step, and an element of a get or a send
FREE = ("issue", "route")
SOURCE = "Teng et al. 1993, Table 1: {count} random sets, {first} to {last}, on {nodes} nodes"
FEWEST = 3  # rows, before constants are fitted to them


def calibrated(ledgers: Mapping[str, sv.Ledger], model: sv.Model = sv.CM5) -> sv.Model:
    """The model with the free constants that come nearest to the paper's times, by least relative squares.

    Parameters
    ----------
    ledgers
        The main loop's ledgers on 32 processors, by name of the set; sets that are not random are ignored.
    model
        Whose other constants stay.

    Raises
    ------
    ValueError
        If there are fewer than three random sets.
    """
    rows = [row for row in RANDOM if row.name in ledgers]
    if len(rows) < FEWEST:
        msg = f"calibration needs at least {FEWEST} of Table 1's random sets, got {len(rows)}"
        raise ValueError(msg)
    source = SOURCE.format(count=len(rows), first=rows[0].name, last=rows[-1].name, nodes=PROCESSORS)
    return sv.calibrate(
        model, [ledgers[row.name] for row in rows], [row.seconds for row in rows], FREE, source
    )

"""Seconds add up by phase, and the ledger has the phases' names."""

import numpy as np

import scanvec as sv
from dt3d.extrapolation.clock import Clock


def test_phases_are_counted_and_named():
    machine = sv.Simulated(processors=2)
    clock = Clock(machine)
    for _ in range(2):
        with clock.phase("first"):
            machine.full(4, 1, np.int32) + 1
    with clock.phase("second"):
        pass
    assert list(clock.seconds) == ["first", "second"]
    assert clock.seconds["first"] > clock.seconds["second"] >= 0
    assert machine.ledger.by_phase()["first"].steps == 2 * machine.ledger.of("first").steps / 2 > 0

"""Constants from measured times."""

import pytest

import scanvec as sv

from .cases import (
    program,
)


def test_calibration_finds_the_constants_that_made_the_times():
    truth = sv.CM5.calibrated("a test", issue=3e-5, element=2e-6, packet=1e-5)
    ledgers = []
    for n in (10, 100, 1000, 3000):
        cm = sv.Simulated(4, model=truth)
        program(cm, n)
        ledgers.append(cm.ledger)
    found = sv.calibrate(
        sv.CM5, ledgers, [x.seconds for x in ledgers], ["issue", "element", "packet"], "test"
    )
    assert found.values == pytest.approx(truth.values)
    assert found.constants["issue"].origin == "calibrated"
    assert found.constants["combine"].origin == "sourced"
    with pytest.raises(ValueError, match="4 ledgers, 1 times"):
        sv.calibrate(sv.CM5, ledgers, [1.0], ["issue"], "test")
    with pytest.raises(ValueError, match="no constant 'weight'"):
        sv.calibrate(sv.CM5, ledgers, [1.0] * 4, ["weight"], "test")

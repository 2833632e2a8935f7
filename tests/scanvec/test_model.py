"""What all cost models have."""

import pytest

import scanvec as sv

from .cases import (
    program,
)

MODELS = (sv.EREW_PRAM, sv.CRCW_PRAM, sv.SCAN, sv.CM2, sv.CM5, sv.HYPERCUBE, sv.MESH2D)


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_every_model_times_every_step(model):
    cm = sv.Simulated(16, model=model)
    program(cm)
    ledger = cm.ledger
    assert all(model.seconds(e, 16) > 0 for e in ledger.entries)
    assert ledger.seconds == pytest.approx(sum(row.seconds for row in ledger.by_phase().values()))
    assert ledger.seconds == pytest.approx(sum(row.seconds for row in ledger.table("operation")))
    assert repr(cm) == f"Simulated(processors=16, model=scanvec.{model.name})"


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_every_constant_says_where_it_comes_from(model):
    for constant in model.constants.values():
        assert constant.origin in ("sourced", "calibrated", "convention", "estimate")
        assert constant.source
    for name, constant in model.constants.items():
        assert f"{constant.origin}" in str(model)
        assert name in str(model)


def test_time_needs_a_model():
    cm = sv.Simulated(4)
    program(cm)
    with pytest.raises(ValueError, match="no cost model.*model=scanvec.CM5"):
        _ = cm.ledger.seconds
    assert cm.ledger.under(sv.CM5).seconds > 0
    assert "seconds" not in str(cm.ledger)
    with pytest.raises(ValueError, match="must be a scanvec model.*'CM5'"):
        sv.Simulated(4, model="CM5")

"""Pictures of ledgers."""

import pytest

import scanvec as sv
import scanvec.plot

from .cases import (
    program,
)


def test_pictures(tmp_path):
    cm = sv.Simulated(8, model=sv.CM5)
    program(cm)
    axes = sv.plot.time_by_primitive(cm.ledger)
    heights = sum(bar.get_height() for bar in axes.patches)
    assert heights == pytest.approx(cm.ledger.seconds)
    axes.figure.savefig(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    axes = sv.plot.time_by_iteration(cm.ledger, "sort", "look up")
    rows = cm.ledger.by_iteration("sort", "look up")
    assert sum(bar.get_height() for bar in axes.patches) == pytest.approx(sum(r.seconds for r in rows))
    axes = sv.plot.load_balance(cm.ledger, ax=sv.plot.new_axes())
    elements = axes.lines[0].get_ydata()
    assert elements.mean() == pytest.approx(1)
    with pytest.raises(ValueError, match="no phase 'none'; it has sort, look up"):
        sv.plot.time_by_iteration(cm.ledger, "none")

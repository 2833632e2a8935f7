"""The costs of virtual time: the file that ships, one that is given, and what is said of a bad one."""

import numpy as np
import pytest
from rich.console import Console

from dt3d.experiments.kohout import busy, costs
from dt3d.experiments.kohout.costs import HEADER, CostTable, Measured, chosen_costs, measure_costs, read
from dt3d.threaded2d.virtual_time.costs import Costs

COLUMNS = ",".join(HEADER)


def row(name, points, visit, interleave=1):
    return Measured(name, points, interleave, Costs(visit=visit, node=5e-8, test=1e-8), 1e-7, 1e-8)


def test_what_ships_has_every_distribution():
    table = chosen_costs("shipped")
    assert {r.name for r in table.rows} == {"grid", "uniform", "gauss", "cluster", "arc", "crater"}
    for r in table.rows:
        assert min(r.costs[:3]) > 1e-9
        assert max(r.costs[:3]) < 2e-6
    assert "ship" in table.source


def test_between_two_sizes_costs_go_by_the_logarithm():
    table = CostTable([row("uniform", 1000, 4e-8), row("uniform", 100_000, 8e-8)], "here")
    assert table.of("uniform", 10_000).costs.visit == pytest.approx(6e-8)
    assert table.of("uniform", 10).costs.visit == pytest.approx(4e-8)
    assert table.of("uniform", 10**7).costs.visit == pytest.approx(8e-8)
    assert table.of("spiral", 1000).costs.visit == pytest.approx(4e-8)
    assert table.of("uniform", 1000, 8).costs.visit == pytest.approx(4e-8)
    more = CostTable([*table.rows, row("uniform", 1000, 1e-8, interleave=8)], "here")
    assert more.of("uniform", 1000, 6).costs.visit == pytest.approx(1e-8)
    with pytest.raises(ValueError, match="no costs of 'gauss' or 'uniform' points in here; it has"):
        CostTable([row("grid", 1000, 4e-8)], "here").of("gauss", 10)


def test_a_file_that_was_measured_can_be_given(tmp_path):
    with open(tmp_path / "screen", "w") as file:
        rows = measure_costs(tmp_path, Console(file=file), points="300", interleave="1", repeats=1)
    table = chosen_costs(str(tmp_path / "kohout-costs.csv"))
    assert len(table.rows) == len(rows) == 6
    assert costs.rows_of(table.rows) == rows
    measured = chosen_costs("measure", [("uniform", 300, 1), ("uniform", 300, 1)])
    assert len(measured.rows) == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"has the columns \(none\); a file of costs has set, points"),
        ("a,b\n1,2\n", "has the columns a, b; a file of costs has"),
        (
            COLUMNS + "\nuniform,many" + ",1" * (len(HEADER) - 2),
            "line 2: expected a name and numbers",
        ),
        (COLUMNS + "\nuniform,10,1" + ",-1" * (len(HEADER) - 3), "line 2: counts must be positive"),
        (
            COLUMNS + "\nuniform,10,1,nan" + ",1" * (len(HEADER) - 4),
            "line 2: counts must be positive",
        ),
    ],
)
def test_errors_of_files(text, message, tmp_path):
    file = tmp_path / "costs.csv"
    file.write_text(text)
    with pytest.raises(ValueError, match=message):
        read(file)


def test_errors_of_names():
    with pytest.raises(ValueError, match="there is no file 'none.csv'"):
        chosen_costs("none.csv")
    with pytest.raises(ValueError, match="there is no distribution 'line'; there are grid"):
        costs.points_of("line", 10)
    assert len(costs.points_of("crater", 50)) == 50
    assert len(np.unique(costs.points_of("crater", 10**6), axis=0)) == 154_224


def test_a_busy_machine_is_told(monkeypatch, tmp_path):
    assert 0 < busy.free_share(1000) < 3
    for share, told in ((0.5, True), (0.97, False)):
        monkeypatch.setattr(busy, "free_share", lambda share=share: share)
        with open(tmp_path / "screen", "w") as file:
            console = Console(file=file, record=True, width=200)
            busy.warn_if_busy(console)
            assert ("the machine is busy. A thread per processor gets 50 %" in console.export_text()) == told

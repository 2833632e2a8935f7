"""`dt3d compare`: both sides in turn, ratios of medians, a table and a CSV."""

import csv
import time

import pytest

from dt3d import cli
from dt3d.bench import comparisons
from dt3d.bench.pairs import Pair, in_turn


def test_a_ratio_is_one_of_medians():
    assert Pair("a", "b", "c", (1.0, 9.0, 2.0), (4.0, 3.0, 40.0)).ratio == 2.0


def test_both_sides_run_in_turn_after_a_call_that_is_not_counted():
    called = []
    seconds = in_turn(lambda: called.append("ours"), lambda: (called.append("theirs"), time.sleep(0.01)), 3)
    assert called == ["ours", *["ours", "theirs"] * 3]
    assert [len(side) for side in seconds] == [3, 3]
    assert min(seconds[1]) >= 0.01 > max(seconds[0])


def test_the_list(capsys):
    assert cli.main(["compare"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(comparisons.COMPARISONS)


@pytest.mark.parametrize("name", comparisons.COMPARISONS)
def test_a_comparison(name, tmp_path, capsys):
    assert cli.main(["compare", name, "--quick", "--rounds", "1", "--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    with (tmp_path / f"compare-{name}.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert rows
    for row in rows:
        assert row["task"] in out
        sides = [list(map(float, row[f"seconds of {side}"].split())) for side in ("dt3d", "the other")]
        ours, theirs = (sorted(side)[len(side) // 2] for side in sides)
        assert float(row["ratio"]) == pytest.approx(theirs / ours, rel=1e-2)


def test_what_is_refused(tmp_path, capsys):
    assert cli.main(["compare", "voronoy", "--out", str(tmp_path)]) == 2
    assert "there is no comparison 'voronoy'; there are interpolation, voronoi, " in capsys.readouterr().err
    assert cli.main(["compare", "voronoi", "--rounds", "0", "--out", str(tmp_path)]) == 2
    assert "--rounds must be at least 1, got 0" in capsys.readouterr().err

"""The programs on the simulator's page run, and the names that it lists exist."""

import re

import numpy as np

import scanvec as sv

from ..documents import page, programs, run

PAGE = page("scanvec/README.md")


def test_the_experiment_of_ones_own(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert len(programs(PAGE)) == 2
    names = run(programs(PAGE))
    assert np.array_equal(names["ranks"].to_numpy()[names["order"]], np.arange(4096)[::-1])
    # what the page says: in the last round one processor answers nearly all, and more nodes help little
    rounds = names["cm5"].ledger.by_iteration("jump")
    assert rounds[-1].busiest > 3500 > 10 * rounds[0].busiest
    times = [ledger.seconds for ledger in names["cm5"].ledgers.values()]
    assert times[0] > times[1] > times[2] > times[0] / 2.5
    assert names["pram"].ledger.conflicts[0].phase == "jump"
    assert "steps are not exclusive; the first: step" in capsys.readouterr().out
    assert len((tmp_path / "steps.csv").read_text().splitlines()) == names["cm5"].ledger.steps + 1


def test_the_names_of_the_table_exist():
    table = PAGE[PAGE.index("## Blelloch's names") :]
    used = set(re.findall(r"sv\.(\w+)", table))
    assert used <= set(sv.__all__)
    # all operations are there
    operations = {name for name in sv.__all__ if name.islower()} - {"calibrate", "union", "unique"}
    assert operations <= used


def test_segmented_forms_of_the_table():
    machine = sv.Simulated(4)
    v = machine.vector([5, 1, 3, 4, 3, 9, 2, 6])
    segments = sv.Segments.from_lengths(machine.vector([3, 0, 5]))
    index = machine.vector([2, 0, 1, 4, 3, 2, 1, 0])
    permuted = sv.permute(v, index + sv.get(segments.starts, segments.ids))
    assert permuted.to_numpy().tolist() == [1, 3, 5, 6, 2, 9, 3, 4]
    third = sv.get(v, sv.pack(segments.starts, segments.lengths > 2) + 2)
    assert third.to_numpy().tolist() == [3, 9]
    assert sv.reduce(v > 3, sv.ADD, segments).to_numpy().tolist() == [1, 0, 3]
    assert segments.offsets.to_numpy().tolist() == [0, 1, 2, 0, 1, 2, 3, 4]

"""The classics of the scan model, as the example has them, against NumPy."""

import importlib.util
from pathlib import Path

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

from .cases import MACHINES, assert_same

PATH = Path(__file__).parents[2] / "examples" / "scan_primitives.py"
spec = importlib.util.spec_from_file_location("scan_primitives", PATH)
classics = importlib.util.module_from_spec(spec)
spec.loader.exec_module(classics)

each_machine = pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[2]], ids=repr)


@each_machine
@given(altitude=st.lists(st.integers(0, 1000), min_size=1, max_size=70))
@settings(max_examples=10)
def test_line_of_sight(machine, altitude):
    visible, steepest = [False], -np.inf
    for distance in range(1, len(altitude)):
        slope = (altitude[distance] - altitude[0]) / distance
        visible.append(slope > steepest)
        steepest = max(slope, steepest)
    assert_same(classics.line_of_sight(machine.vector(altitude, float)), np.array(visible))


@each_machine
@given(keys=st.lists(st.integers(0, 31), max_size=70))
@settings(max_examples=10)
def test_split_radix_sort(machine, keys):
    keys = np.array(keys, np.uint16)
    assert_same(classics.split_radix_sort(machine.vector(keys), bits=5), np.sort(keys))


@each_machine
@given(keys=st.lists(st.integers(-20, 20), max_size=40))
@settings(max_examples=8)
def test_quicksort(machine, keys):
    got, rounds = classics.quicksort(machine.vector(keys, np.int32))
    assert_same(got, np.sort(np.array(keys, np.int32)))
    assert rounds <= len(set(keys))  # each round puts one value, at least, in its place


def test_quicksort_of_random_keys_takes_few_rounds():
    keys = np.random.default_rng(1).permutation(1000).astype(np.int32)
    got, rounds = classics.quicksort(MACHINES[2].vector(keys))
    assert_same(got, np.arange(1000, dtype=np.int32))
    assert rounds < 4 * np.log2(1000)


def test_the_printed_tables(capsys):
    classics.main([])
    out = capsys.readouterr().out
    for name in ("line of sight", "radix sort", "quicksort", "busiest"):
        assert name in out

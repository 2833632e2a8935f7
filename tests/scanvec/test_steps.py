"""The steps that the docstrings state, against the ledger; and those over nothing."""

import inspect
import re

import numpy as np
import pytest

import scanvec as sv

WORDS = "zero|one|two|three|four|five|six|seven|eight|nine|ten|eleven|twelve|thirteen"
STATES_STEPS = re.compile(rf"\b({WORDS}) (?:scan |elementwise )?steps?\b")


class Inputs:
    """Vectors of 8 elements, and segments of them, on 4 processors."""

    def __init__(self, n: int = 8) -> None:
        self.cm = sv.Simulated(processors=4)
        self.v = self.cm.vector(np.arange(n) * 3 % 8)
        self.floats = self.cm.vector(np.zeros(n))
        self.flags = self.cm.vector(np.arange(n) % 3 == 1)
        self.index = self.cm.vector(np.arange(n)[::-1])
        self.counts = self.cm.vector(np.arange(n) % 3)
        self.lengths = self.cm.vector(np.array([3, 0, 5] if n else [], int))
        self.segments = sv.Segments.from_lengths(self.lengths)
        # to merge by the flags
        self.clear, self.set = sv.pack(self.v, ~self.flags), sv.pack(self.v, self.flags)
        self.cm.ledger.entries.clear()


def steps(program, n: int = 8) -> int:
    x = Inputs(n)
    program(x)
    return x.cm.ledger.steps


# what is documented, a program, its steps over 8 elements, over none
STATED = [
    (sv.Machine.map, lambda x: x.cm.map(abs, x.v), 1, 1),
    (sv.Machine.scan, lambda x: x.cm.scan(x.v, sv.ADD, exclusive=True), 1, 1),
    (sv.Machine.get, lambda x: x.cm.get(x.v, x.index), 1, 1),
    (sv.Machine.send, lambda x: x.cm.send(x.v, x.index, sv.ADD, into=x.v), 1, 1),
    (sv.Machine.iota, lambda x: x.cm.iota(8), 1, 1),
    (sv.Vector.astype, lambda x: x.v.astype("int8"), 1, 1),
    (sv.scan, lambda x: sv.scan(x.v, sv.ADD, x.segments), 1, 1),
    (sv.scan_inclusive, lambda x: sv.scan_inclusive(x.v, sv.MAX), 1, 1),
    (sv.backscan, lambda x: sv.backscan(x.v, sv.MAX), 1, 1),
    (sv.backscan_inclusive, lambda x: sv.backscan_inclusive(x.v, sv.COPY, x.segments), 1, 1),
    (sv.copy_scan, lambda x: sv.copy_scan((x.v, x.floats), x.segments), 1, 1),
    (sv.enumerate, lambda x: sv.enumerate(x.flags, x.segments), 2, 2),
    (sv.reduce, lambda x: sv.reduce(x.v, sv.ADD), 1, 0),
    (sv.get, lambda x: sv.get(x.v, x.index), 1, 1),
    (sv.send, lambda x: sv.send(x.v, x.index, sv.MIN, into=x.v), 1, 1),
    (sv.scatter, lambda x: sv.scatter((x.v, x.v), x.index, into=(x.v, x.v)), 1, 1),
    (sv.permute, lambda x: sv.permute((x.v, x.floats), x.index), 1, 1),
    (sv.pack, lambda x: sv.pack((x.v, x.floats), x.flags), 4, 4),
    (sv.pack_index, lambda x: sv.pack_index(x.flags), 5, 5),
    (sv.split, lambda x: sv.split((x.v, x.floats), x.flags), 5, 0),
    (sv.where, lambda x: sv.where(x.flags, x.v, x.v), 1, 1),
    (sv.flag_merge, lambda x: sv.flag_merge(x.clear, x.set, x.flags), 7, 7),
    (sv.insert, lambda x: sv.insert(x.cm.full(8, 0, "int8"), 3, 1), 1, 1),
    (sv.op_distribute, lambda x: sv.op_distribute(x.v, sv.MAX, x.segments), 2, 2),
    (sv.append, lambda x: sv.append(x.v, x.v), 5, 0),
    (sv.distribute, lambda x: sv.distribute(x.v, x.counts), 12, 1),
    (sv.Segments.from_lengths, lambda x: sv.Segments.from_lengths(x.lengths), 11, 0),
    (sv.Segments.from_flags, lambda x: sv.Segments.from_flags(x.flags), 8, 0),
    (sv.Segments.from_ids, lambda x: sv.Segments.from_ids(x.v), 13, 0),
    (sv.Segments.offsets.fget, lambda x: x.segments.offsets, 3, 3),
]  # fmt: skip
each = pytest.mark.parametrize(
    ("documented", "program", "full", "empty"), STATED, ids=[row[0].__qualname__ for row in STATED]
)


@each
def test_steps(documented, program, full, empty):
    assert steps(program) == full
    assert steps(program, n=0) == empty
    if "n elements" in (documented.__doc__ or ""):
        x = Inputs()
        program(x)
        assert {e.elements for e in x.cm.ledger.entries} <= {8, 16}


@each
def test_what_the_docstring_says(documented, program, full, empty):
    text = inspect.getdoc(documented).lower()
    stated = STATES_STEPS.search(text)
    assert stated is not None
    assert WORDS.split("|").index(stated[1]) == full


def test_no_stated_count_is_missing_here():
    functions = [getattr(sv, name) for name in sv.__all__]
    functions += [f for c in (sv.Machine, sv.Vector, sv.Segments) for f in vars(c).values()]
    functions = [getattr(f, "__func__", getattr(f, "fget", f)) for f in functions]  # as the class has them
    tested = [getattr(row[0], "__func__", row[0]) for row in STATED]
    for f in filter(inspect.isfunction, functions):
        assert f in tested or not STATES_STEPS.search((f.__doc__ or "").lower()), f


@pytest.mark.parametrize(
    ("program", "count"),
    [
        (lambda x: sv.reduce(x.v, sv.ADD, x.segments), 5),
        (lambda x: sv.reduce((x.v, x.floats), sv.ADD, x.segments), 6),
        (lambda x: sv.reduce(x.flags, sv.ADD), 2),
        (lambda x: sv.reduce(x.flags, sv.ADD, x.segments), 6),
        (lambda x: sv.scan(x.flags, sv.ADD), 2),
        (lambda x: sv.op_distribute(x.flags, sv.ADD), 3),
        (lambda x: sv.split(x.v, x.flags, x.segments), 7),
        (lambda x: sv.append(x.cm.vector([]), x.floats), 3),
        (lambda x: sv.append(x.floats, x.cm.vector([])), 2),
    ],
)
def test_special_cases(program, count):
    assert steps(program) == count


@pytest.mark.parametrize("bits", [0, 1, 3, 8])
def test_a_sort_takes_six_steps_for_each_bit_in_which_keys_differ(bits):
    def keys(x):
        return x.cm.vector(np.array([0, 2**bits - 1, 0, 0, 2**bits - 1, 0, 0, 0]))

    assert steps(lambda x: sv.sort(keys(x))) == 6 + 6 * bits
    assert steps(lambda x: sv.rank(keys(x))) == 7 + 6 * bits
    # the ids of the elements, 0 and 2, differ in one bit; four steps look at them as a further key
    assert steps(lambda x: sv.segmented_sort(keys(x), x.segments)) == 6 + 6 * (bits + 1) + 4


def test_sorts_of_nothing():
    assert steps(lambda x: sv.sort(x.v), n=0) == 2
    assert steps(lambda x: sv.rank(x.v), n=0) == 3
    assert steps(lambda x: sv.union(x.v, x.v), n=0) == 0

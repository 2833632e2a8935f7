"""Three small programs, counted by hand: steps, VP ratios, operations, messages, and time under each model.

8 elements on 4 processors, two on each, unless a test says otherwise.
"""

import numpy as np
import pytest

import scanvec as sv

from .cases import count_letters, square_and_sum

# primitive, elements, VP ratio, messages, busiest, bytes, operations, accesses
COLUMNS = ("primitive", "elements", "vp_ratio", "messages", "busiest", "bytes", "operations", "accesses")


SQUARE_AND_SUM = [
    ("map", 8, 2, 0, 0, 0, 1, 0),
    # partial sums of processors 0, 1, 2 go to the next one
    ("scan", 8, 2, 3, 1, 8, 1, 0),
]


def reverse_and_pack(cm: sv.Simulated) -> None:
    """The odd ones of 7, 6, ..., 0: an exclusive write, and a pack."""
    v = cm.vector(np.arange(8))
    v = sv.permute(v, cm.vector(np.arange(8)[::-1]))
    sv.pack(v, v % 2 == 1)


REVERSE_AND_PACK = [
    # everyone's two elements go to another processor
    ("send", 8, 2, 8, 2, 8, 1, 1),
    # jnp.remainder corrects the sign that the machine's remainder has, by operations that JAX chooses
    ("map", 8, 2, 0, 0, 0, None, 0),
    ("map", 8, 2, 0, 0, 0, 1, 0),
    # the flags become integers and are counted
    ("map", 8, 2, 0, 0, 0, 1, 0),
    ("scan", 8, 2, 3, 1, 4, 1, 0),
    ("map", 8, 2, 0, 0, 0, 1, 0),
    # 7, 5, 3, 1 of processors 0 to 3 go to places 0 to 3, one on each processor: none moves
    ("send", 8, 2, 0, 0, 8, 1, 1),
]


COUNT_LETTERS = [
    # letter k is counted on processor k: 0 stays where it is, 1 crosses from processor 0; the two 0 of
    # processor 1 cross; 2 is at home, 0 crosses; 3 is at home, 0 crosses. Processor 0 gets 4, processor 1 one
    ("send", 8, 2, 5, 4, 4, 1, 5),
    # the same 5 ask, and get replies; processor 0 is asked by 4 and asks 1
    ("get", 8, 2, 10, 5, 4, 1, 5),
]

PROGRAMS = [
    (square_and_sum, SQUARE_AND_SUM),
    (reverse_and_pack, REVERSE_AND_PACK),
    (count_letters, COUNT_LETTERS),
]


@pytest.mark.parametrize(("program", "expected"), PROGRAMS)
def test_counts(program, expected):
    # under EREW_PRAM accesses are counted too
    cm = sv.Simulated(4, model=sv.EREW_PRAM)
    program(cm)
    counted = [tuple(getattr(e, c) for c in COLUMNS) for e in cm.ledger.entries]
    assert len(counted) == len(expected)
    for got, want in zip(counted, expected, strict=True):
        assert all(w is None or g == w for g, w in zip(got, want, strict=True)), (got, want)


@pytest.mark.parametrize(("program", "expected"), PROGRAMS)
def test_counts_do_not_change_from_run_to_run(program, expected):
    machines = [sv.Simulated(4, model=sv.CM5) for _ in range(2)]
    for cm in machines:
        program(cm)
    assert machines[0].ledger == machines[1].ledger
    assert machines[0].ledger.seconds == machines[1].ledger.seconds

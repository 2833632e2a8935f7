"""The ledger against counts by hand: 8 elements on 4 processors, two on each."""

import numpy as np
import pytest

import scanvec as sv

BACKWARD = np.arange(8)[::-1]


@pytest.fixture
def cm():
    return sv.Simulated(processors=4)


@pytest.fixture
def v(cm):
    return cm.vector(np.arange(8))


def only_entry(cm: sv.Simulated) -> sv.Entry:
    (entry,) = cm.ledger.entries
    return entry


def test_a_map_sends_nothing(cm, v):
    _ = v + 1
    assert only_entry(cm) == sv.Entry("", "map", "map", 8, 2, 0, 0, 0)


def test_a_scan_passes_one_partial_result_on_from_each_processor_but_the_last(cm, v):
    sv.scan(v, sv.ADD)
    assert only_entry(cm) == sv.Entry("", "scan", "scan", 8, 2, messages=3, busiest=1, bytes=8)


@pytest.mark.parametrize(
    ("index", "messages", "busiest"),
    [
        (np.arange(8), 0, 0),
        # everyone asks 2, is asked 2, and so sends 2 requests and 2 replies
        (BACKWARD, 16, 4),
        # 6 requests to the first processor, and as many replies
        (np.zeros(8, int), 12, 6),
        # elements 0 and 7, asked for by 3 and 4 on processors 1 and 2
        (np.array([0, 0, 2, 0, 7, 4, 6, 6]), 4, 1),
        # a longer vector asks a shorter one: 16 elements, four on each
        (np.arange(16) // 2, 0, 0),
    ],
)
def test_get(cm, v, index, messages, busiest):
    sv.get(v, cm.vector(index))
    assert only_entry(cm) == sv.Entry("", "get", "get", len(index), len(index) // 4, messages, busiest, 8)


@pytest.mark.parametrize(
    ("index", "m", "messages", "busiest"),
    [
        (np.arange(8), 8, 0, 0),
        (BACKWARD, 8, 8, 2),
        # six elements come to processor 0
        (np.zeros(8, int), 8, 6, 6),
        # into 4 elements, one on each processor: 0 and 1 go to place 0, on the processor where they are
        (np.arange(8) // 2, 4, 0, 0),
        # into 16, four on each: 2 .. 7 leave their processors, the last two to places 6 and 7 on processor 1
        (np.arange(8), 16, 6, 4),
    ],
)
def test_send(cm, v, index, m, messages, busiest):
    sv.send(v, cm.vector(index), sv.ADD, into=cm.vector(np.zeros(m, int)))
    n = max(8, m)
    assert only_entry(cm) == sv.Entry("", "send", "send", n, n // 4, messages, busiest, 8)


def test_elements_outside_the_context_send_nothing(cm, v):
    where = cm.vector(np.arange(8) == 0)
    index = cm.vector(BACKWARD)
    sv.get(v, index, where=where, otherwise=0)
    sv.scatter(v, index, into=v, where=where)
    assert [(e.messages, e.busiest) for e in cm.ledger.entries] == [(2, 1), (1, 1)]


def test_a_record_travels_as_one_message(cm, v):
    record = (v, cm.vector(np.zeros(8, np.int8)), cm.vector(np.zeros(8, np.float16)))
    sv.permute(record, cm.vector(BACKWARD))
    entry = only_entry(cm)
    assert (entry.messages, entry.bytes) == (8, 11)


@pytest.mark.parametrize(
    ("n", "ratio", "messages"), [(0, 1, 0), (1, 1, 0), (3, 1, 2), (5, 2, 2), (9, 3, 2), (13, 4, 3)]
)
def test_the_vp_ratio_is_the_ceiling_of_n_over_p(cm, n, ratio, messages):
    # 5 elements lie on three processors, two on each
    sv.scan(cm.vector(np.zeros(n, int)), sv.ADD)
    busiest = min(messages, 1)
    assert only_entry(cm) == sv.Entry("", "scan", "scan", n, ratio, messages, busiest, bytes=8)
    assert cm.vp_ratio(n) == ratio


def test_one_processor_has_nobody_to_talk_to():
    cm = sv.Simulated(processors=1)
    v = cm.vector(np.arange(8))
    sv.sort(sv.permute(v, cm.vector(BACKWARD)))
    assert cm.ledger.messages == 0


def test_what_failed_is_not_entered(cm, v):
    with pytest.raises(IndexError):
        sv.get(v, v + 1)
    assert [e.primitive for e in cm.ledger.entries] == ["map"]


def program(cm: sv.Simulated) -> None:
    v = cm.vector([3, 1, 2, 1, 0, 3, 2, 2])
    with cm.phase("first"):
        flags = v > 1
        with cm.phase("inner"):
            sv.pack(v, flags)
        with cm.operation("mine"):
            sv.enumerate(flags)
    sv.unique(v)


def test_phases_and_operations(cm):
    program(cm)
    seen = dict.fromkeys((e.phase, e.operation) for e in cm.ledger.entries)
    # the innermost phase and the outermost operation count: unique calls sort and pack
    assert list(seen) == [("first", "map"), ("inner", "pack"), ("first", "mine"), ("", "unique")]


def test_an_operation_is_named_when_all_arguments_are_given_by_keyword(cm, v):
    sv.pack(v=v, flags=v > 3)
    assert {e.operation for e in cm.ledger.entries} == {"map", "pack"}


def test_two_runs_have_one_ledger():
    first, second = sv.Simulated(processors=4), sv.Simulated(processors=4)
    program(first)
    program(second)
    assert first.ledger == second.ledger
    assert first.ledger.steps > 10


def test_machines_that_keep_no_ledger_take_phases_too():
    device = sv.Device()
    program(device)
    assert device.ledger is None


def test_sums(cm, v):
    _ = v + 1
    sv.get(v, cm.vector(BACKWARD))
    assert (cm.ledger.steps, cm.ledger.elements, cm.ledger.messages) == (2, 16, 16)


def test_tables(cm, v):
    with cm.phase("a"):
        sv.split(v, v > 3)
    with cm.phase("b"):
        _ = v + 1
    by_primitive = {row.primitive: row for row in cm.ledger.table("primitive")}
    assert list(by_primitive) == ["map", "scan", "send"]
    # > and the conversion, the indices and the targets of split, and +
    assert by_primitive["map"] == sv.Row("", "", "map", 5, 40, 10, 2, 0, 0)
    assert by_primitive["scan"] == sv.Row("", "", "scan", 1, 8, 2, 2, 3, 1)
    assert [(row.phase, row.steps) for row in cm.ledger.table("phase")] == [("a", 6), ("b", 1)]
    assert [(r.phase, r.operation, r.steps) for r in cm.ledger.table("operation", "phase")] == [
        ("a", "map", 1),
        ("a", "split", 5),
        ("b", "map", 1),
    ]
    # without keys: by operation and primitive, which is what is printed
    assert [(r.operation, r.primitive) for r in cm.ledger.table()] == [
        ("map", "map"),
        ("split", "map"),
        ("split", "scan"),
        ("split", "send"),
    ]
    lines = str(cm.ledger).splitlines()
    assert lines[0].split()[:5] == ["operation", "primitive", "steps", "elements", "vp_steps"]
    assert lines[1].split() == ["map", "map", "2", "16", "4", "2", "0", "0"]
    assert len({len(line) for line in lines}) == 1
    with pytest.raises(ValueError, match="by 'bytes'; use phase, operation, primitive"):
        cm.ledger.table("bytes")


def test_an_empty_ledger_prints_its_head(cm):
    assert str(cm.ledger).split()[0] == "operation"

"""Operations that are entered under their own names."""

import scanvec as sv
from scanvec._primitives.composed import composed


@composed
def twice(v: sv.Vector) -> sv.Vector:
    """A step and an operation that is composed itself."""
    return sv.copy_scan(v + v)


def test_the_outermost_name_counts():
    cm = sv.Simulated(4)
    v = cm.iota(8)
    twice(v)
    sv.copy_scan(v=v)
    assert [e.operation for e in cm.ledger.entries] == ["map", "twice", "twice", "copy_scan"]
    assert twice(v=v).to_numpy().tolist() == [0] * 8


def test_names_and_documents_are_the_function_s():
    assert twice.__name__ == "twice"
    assert twice.__doc__.startswith("A step")

"""What is entered of a step."""

import dataclasses

import pytest

import scanvec as sv


def test_entries_are_values():
    entry = sv.Entry("search", "pack", "scan", 8, 2, messages=3, busiest=1, bytes=4)
    assert (entry.operations, entry.accesses, entry.visit) == (1, 0, 0)
    assert entry == dataclasses.replace(entry)
    with pytest.raises(dataclasses.FrozenInstanceError):
        entry.phase = ""


def test_every_attribute_is_documented():
    for field in dataclasses.fields(sv.Entry):
        assert f"{field.name} : " in sv.Entry.__doc__

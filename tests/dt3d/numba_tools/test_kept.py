"""What is said where compiled code cannot be kept."""

import errno
import logging

from dt3d._numba.kept import CURE, Kept


def test_what_is_lost_is_said_once_and_not_where_nothing_is_kept(monkeypatch, caplog):
    monkeypatch.setattr(Kept, "said", False)
    monkeypatch.setattr(Kept, "anywhere", False)
    error = OSError(errno.ENOSPC, "No space left on device")
    with caplog.at_level(logging.WARNING, "dt3d"):
        Kept.lost("/a/folder", error)
        assert not caplog.records
        monkeypatch.setattr(Kept, "anywhere", True)
        Kept.lost("/a/folder", error)
        Kept.lost("/a/folder", error)
    (record,) = caplog.records
    said = record.getMessage()
    assert "/a/folder (No space left on device)" in said
    assert said.endswith(CURE)

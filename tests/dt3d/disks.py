"""Disks that get full."""

import signal
from contextlib import contextmanager

import pytest

resource = pytest.importorskip("resource")  # of POSIX


@contextmanager
def small_files(limit):
    """A limit to the size of files stands for a full disk: writing fails half way (EFBIG for ENOSPC)."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)

"""`cached_njit`: functions compiled by numba, kept on disk as long as they are what the sources say.

numba's own ``cache=True`` does not see that a function of another module, compiled into one, has changed; it
ends the program where no folder can be written, where a file of its cache is cut off, or where the disk is
full; and two processes that save at once can leave one's code under the other's name. Here a record on disk
says what it was made from (`sources`), for which types and processor, and has a checksum; what does not fit
is compiled again.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import time
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

from .kept import Kept

if TYPE_CHECKING:
    from numba.core.caching import IndexDataCacheFile, _CacheLocator

SECONDS_FOR_LOCK = 2.0  # seconds for another process to save what it has compiled


def cached_njit(function: Callable[..., object] | None = None, **options: object) -> Any:
    """Decorate a function as ``numba.njit(cache=True)`` does, with a cache that is never stale.

    ``@cached_njit`` or, with options of ``numba.njit``, ``@cached_njit(nogil=True)``.
    """
    if function is None:
        return lambda function: cached_njit(function, **options)
    import numba

    from .announce import announce_compilation

    announce_compilation()
    _forks_wait()
    dispatcher = numba.njit(**options)(function)
    if not hasattr(dispatcher, "enable_caching"):  # NUMBA_DISABLE_JIT leaves the function as it is
        return dispatcher
    try:
        cache_class = source_cache()
        if cache_class is None:
            dispatcher.enable_caching()
        else:
            dispatcher._cache = cache_class(function)
    except RuntimeError as error:  # by which numba says that no folder can be written
        if "no locator available" not in str(error):
            raise
        Kept.anywhere = False
    return dispatcher


@cache
def _forks_wait() -> None:
    """Let forks wait until no other thread compiles: its lock would stay locked in the child, for ever."""
    from numba.core.compiler_lock import global_compiler_lock as lock

    if hasattr(os, "register_at_fork"):  # not on Windows, which has no fork
        os.register_at_fork(before=lock.acquire, after_in_parent=lock.release, after_in_child=lock.release)


@cache
def source_cache() -> type | None:
    """The cache that is made from numba's; None where this numba has another form, and caches in its way."""
    try:
        from .numba_cache import SourceCache
    except (ImportError, AttributeError):
        return None
    return SourceCache


def is_kept(kernel: Any) -> bool:
    """Whether there is a record on disk of a kernel, for this processor and some types; it is not read."""
    records = getattr(kernel._cache, "_cache_file", None)
    return isinstance(records, Records) and records.has_any_for(kernel.targetctx.codegen().magic_tuple())


class Records:
    """Records in the files of one function: each says what it is, and is checked when it is read."""

    def __init__(self, file: IndexDataCacheFile, locator: _CacheLocator) -> None:
        self.file = file
        self.folder = locator.get_cache_path()
        self.stamp = locator.get_source_stamp()

    def load(self, key: object) -> object:
        """Return what was saved under a key; None if nothing, or nothing whole, was."""
        record = self.file.load(key)
        if not isinstance(record, tuple) or len(record) != 4:
            return None
        made_for, made_from, checksum, data = record
        if (made_for, made_from, checksum) != (key, self.stamp, zlib.crc32(data)):
            return None
        return pickle.loads(data)

    def has_any_for(self, processor: object) -> bool:
        """Return whether something was saved for a processor, which a part of each key names."""
        return any(processor in key for key in self.file._load_index())

    def save(self, key: object, data: object) -> None:
        """Save under a key; raises OSError."""
        dumped = self.file._dump(data)
        record = (key, self.stamp, zlib.crc32(dumped), dumped)
        with _alone(self.folder):
            try:
                self.file.save(key, record)
            except OSError:
                raise
            except Exception:  # the index is garbled
                self.file.flush()
                self.file.save(key, record)

    def flush(self) -> None:
        """Forget what was saved."""
        self.file.flush()


@contextlib.contextmanager
def _alone(folder: str) -> Iterator[None]:
    """Keep other processes from saving in a folder, where the system can.

    An index is read, changed and written. What another process enters meanwhile would be lost, and compiled
    again.
    """
    try:
        import fcntl

        handle = os.open(folder, os.O_RDONLY)
    except (ImportError, OSError):
        yield
        return
    try:
        begun = time.monotonic()
        while time.monotonic() - begun < SECONDS_FOR_LOCK:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                time.sleep(0.01)
            except OSError:  # a file system without locks
                break
            else:
                break
        yield
    finally:
        os.close(handle)

"""`cached_njit`: functions compiled by numba, kept on disk as long as they are what the sources say.

numba's own ``cache=True`` does not see that a function of another module, compiled into one, has changed; it
ends the program where no folder can be written, where a file of its cache is cut off, or where the disk is
full; and two processes that save at once can leave one's code under the other's name. Here a record on disk
says what it was made from (`_sources`), for which types and processor, and has a checksum; what does not fit
is compiled again.
"""

from __future__ import annotations

import contextlib
import logging
import os
import pickle
import time
import zlib
from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import Any

from ._sources import fingerprint

CURE = "set the environment variable NUMBA_CACHE_DIR to a folder that can be written"
PATIENCE = 2.0  # seconds for another process to save what it has compiled


def cached_njit(function: Callable | None = None, **options: Any) -> Any:
    """``numba.njit(cache=True)`` with a cache that is never stale and never in the way; a decorator.

    ``@cached_njit`` or, with options of ``numba.njit``, ``@cached_njit(nogil=True)``.
    """
    if function is None:
        return partial(cached_njit, **options)
    import numba

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


class Kept:
    """Whether what is compiled now will be there for the next process."""

    anywhere = True
    said = False

    @classmethod
    def lost(cls, folder: str, error: OSError) -> None:
        """Say once that what was compiled could not be saved."""
        if cls.anywhere and not cls.said:
            cls.said = True
            logging.getLogger("dt3d").warning(
                "what was compiled could not be kept in %s (%s): other processes compile it again; %s",
                folder, error.strerror or error, CURE,
            )  # fmt: skip


@cache
def _forks_wait() -> None:
    """Let forks wait until no other thread compiles: its lock would stay locked in the child, for ever."""
    from numba.core.compiler_lock import global_compiler_lock as lock

    if hasattr(os, "register_at_fork"):  # not on Windows, which has no fork
        os.register_at_fork(before=lock.acquire, after_in_parent=lock.release, after_in_child=lock.release)


@cache
def source_cache() -> type | None:
    """numba's cache of functions with records that are checked; None where this numba has another form.

    Then functions are cached as numba does it.
    """
    import numba

    try:
        from numba.core import caching

        parts = (
            caching.FunctionCache.load_overload,
            caching.FunctionCache.save_overload,
            caching.CompileResultCacheImpl._locator_classes,
            caching.IndexDataCacheFile.load,
            caching.IndexDataCacheFile.save,
            caching.IndexDataCacheFile.flush,
        )
        folders = (
            caching.UserProvidedCacheLocator,
            caching.InTreeCacheLocator,
            caching.UserWideCacheLocator,
        )
        parts += (caching.ZipCacheLocator.get_suitable_cache_subpath,)
    except (ImportError, AttributeError):
        return None
    assert parts

    class Readable:
        """A folder that was filled before and cannot be written now, as in the image of a container."""

        def ensure_cache_path(self) -> None:
            if not os.path.isdir(self.get_cache_path()):  # type: ignore[attr-defined]
                msg = "no such folder"
                raise OSError(msg)

    class UserProvidedZip(caching.ZipCacheLocator):
        """NUMBA_CACHE_DIR for packages in zip files, too, for which numba does not look at it."""

        @classmethod
        def from_function(cls, function: Callable, file: str) -> Any:
            made = super().from_function(function, file) if numba.config.CACHE_DIR else None
            if made is not None:
                made._cache_path = os.path.join(numba.config.CACHE_DIR, cls.get_suitable_cache_subpath(file))
            return made

    class Implementation(caching.CompileResultCacheImpl):
        _locator_classes = [
            UserProvidedZip,
            *caching.CompileResultCacheImpl._locator_classes,
            *(type(f"Readable{folder.__name__}", (Readable, folder), {}) for folder in folders),
        ]

        def __init__(self, function: Callable) -> None:
            super().__init__(function)
            if isinstance(self.locator, Readable):
                Kept.anywhere = False
            stamp = fingerprint(function.__module__)
            if stamp is not None:
                self.locator.get_source_stamp = lambda: stamp

    class SourceCache(caching.FunctionCache):
        _impl_class = Implementation

        def __init__(self, function: Callable) -> None:
            super().__init__(function)
            self._cache_file = Records(self._cache_file, self._impl.locator)

        def load_overload(self, sig: Any, target_context: Any) -> Any:
            try:
                return super().load_overload(sig, target_context)
            except Exception:  # whatever unpickling a garbled index can raise
                return None

        def save_overload(self, sig: Any, data: Any) -> None:
            try:
                super().save_overload(sig, data)
            except OSError as error:
                Kept.lost(self.cache_path, error)

    return SourceCache


class Records:
    """Records in the files of one function: each says what it is, and is checked when it is read."""

    def __init__(self, file: Any, locator: Any) -> None:
        self.file = file
        self.folder = locator.get_cache_path()
        self.stamp = locator.get_source_stamp()

    def load(self, key: Any) -> Any:
        """What was saved under a key; None if nothing, or nothing whole, was."""
        record = self.file.load(key)
        if not isinstance(record, tuple) or len(record) != 4:
            return None
        made_for, made_from, checksum, data = record
        if (made_for, made_from, checksum) != (key, self.stamp, zlib.crc32(data)):
            return None
        return pickle.loads(data)

    def save(self, key: Any, data: Any) -> None:
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
    """Keep other processes from saving in a folder, where the system can: an index is read, changed and
    written, and what another one enters meanwhile would be lost, and compiled again."""
    try:
        import fcntl

        handle = os.open(folder, os.O_RDONLY)
    except (ImportError, OSError):
        yield
        return
    try:
        begun = time.monotonic()
        while time.monotonic() - begun < PATIENCE:
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

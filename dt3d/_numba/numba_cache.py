"""numba's cache of functions with records that are checked, and with more places to keep them.

Made from numba's own classes, whose form nobody promises: where they have another one, importing this module
fails, and `kernel_cache` leaves caching to numba.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import ClassVar

from numba.core import caching, config
from numba.core.base import BaseContext
from numba.core.typing.templates import Signature

from .kept import Kept
from .kernel_cache import Records
from .sources import fingerprint


class _Readable:
    """A folder that was filled before and cannot be written now, as in the image of a container."""

    get_cache_path: Callable[[], str]

    def ensure_cache_path(self) -> None:
        if not os.path.isdir(self.get_cache_path()):
            msg = "no such folder"
            raise OSError(msg)


class _UserProvidedReadable(_Readable, caching.UserProvidedCacheLocator):
    pass


class _InTreeReadable(_Readable, caching.InTreeCacheLocator):
    pass


class _UserWideReadable(_Readable, caching.UserWideCacheLocator):
    pass


class _UserProvidedZip(caching.ZipCacheLocator):
    """NUMBA_CACHE_DIR for packages in zip files, too, for which numba does not look at it."""

    @classmethod
    def from_function(cls, function: Callable[..., object], file: str) -> caching.ZipCacheLocator | None:
        chosen = config.CACHE_DIR
        made = super().from_function(function, file) if chosen else None
        if made is not None:
            made._cache_path = os.path.join(chosen, cls.get_suitable_cache_subpath(file))
        return made


class _Implementation(caching.CompileResultCacheImpl):
    _locator_classes: ClassVar[list[type]] = [
        _UserProvidedZip,
        *caching.CompileResultCacheImpl._locator_classes,
        _UserProvidedReadable,
        _InTreeReadable,
        _UserWideReadable,
    ]

    def __init__(self, function: Callable[..., object]) -> None:
        super().__init__(function)
        if isinstance(self.locator, _Readable):
            Kept.anywhere = False
        stamp = fingerprint(function.__module__)
        if stamp is not None:
            self.locator.get_source_stamp = lambda: stamp


class SourceCache(caching.FunctionCache):
    """What a function compiled by numba loads from and saves to."""

    _impl_class = _Implementation
    _cache_file: Records

    def __init__(self, function: Callable[..., object]) -> None:
        super().__init__(function)
        self._cache_file = Records(self._cache_file, self._impl.locator)

    def load_overload(self, sig: Signature, target_context: BaseContext) -> object:
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # whatever unpickling a garbled index can raise
            return None

    def save_overload(self, sig: Signature, data: object) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            Kept.lost(self.cache_path, error)

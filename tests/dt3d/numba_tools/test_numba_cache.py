"""numba's classes of locators, each with one that only reads; `test_kernel_cache` has what they do."""

import numba
import pytest
from numba.core import caching

from dt3d._numba import numba_cache


def test_every_folder_of_numba_comes_before_those_that_only_read():
    locators = numba_cache._Implementation._locator_classes
    numbas = caching.CompileResultCacheImpl._locator_classes
    assert locators[1 : 1 + len(numbas)] == numbas
    assert all(issubclass(each, numba_cache._Readable) for each in locators[1 + len(numbas) :])


def test_a_folder_that_is_not_there_does_not_serve(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "nowhere"))
    locator = numba_cache._UserProvidedReadable(test_a_folder_that_is_not_there_does_not_serve, __file__)
    with pytest.raises(OSError, match="no such folder"):
        locator.ensure_cache_path()

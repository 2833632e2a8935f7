"""Functions that are called by their addresses, which an array holds."""

import logging

import numba
import numpy as np
import pytest
from numba.core import types
from numba.extending import intrinsic

from dt3d import InternalError
from dt3d._numba.by_address import Functions, address_of, call_at

FINDER, PLACE = 1, 3
KINDS = (types.UniTuple(types.float64, 2), types.int64)


@numba.njit
def weighted(pair, k):
    return pair[0] + k * pair[1]


@numba.njit
def other(pair, k):
    return -1.0


@numba.njit
def fails(pair, k):
    if k > 0:
        msg = "as it was told to"
        raise InternalError(msg)
    return pair[0]


FUNCTIONS = Functions(FINDER)
FUNCTIONS.add(PLACE, weighted, KINDS)


@intrinsic
def call_it(typingctx, holder, pair, k):
    return call_at(holder, PLACE, types.float64, FUNCTIONS)


@numba.njit
def kernel(holder, x, k):
    return call_it(holder, (x, 2.0 * x), k)


@numba.njit(nogil=True)
def without_the_lock(holder, x, k):
    return call_it(holder, (x, 2.0 * x), k)


def addresses(functions=None):
    """An array with what is known, and its addresses."""
    holder = np.zeros(5)
    words = holder.view(np.int64)
    if functions is not None:
        functions.write(words)
    return holder, words


def test_what_is_called_is_what_the_address_is_of():
    holder, words = addresses()
    for function, expected in ((weighted, 1.5 + 7 * 3.0), (other, -1.0)):
        words[PLACE] = address_of(function, KINDS)
        assert kernel(holder, 1.5, 7) == expected
        assert kernel(holder, 1.5, np.uint8(7)) == expected  # arguments are cast
    assert address_of(weighted, KINDS) == address_of(weighted, KINDS) != address_of(other, KINDS)


def test_what_a_function_raises_comes_through():
    holder, words = addresses()
    words[PLACE] = address_of(fails, KINDS)
    with pytest.raises(InternalError, match="as it was told to"):
        kernel(holder, 1.5, 7)


def test_an_array_without_a_finder_is_an_error():
    with pytest.raises(InternalError, match=f"there is no address at {PLACE}"):
        kernel(np.zeros(5), 1.5, 7)


@pytest.mark.parametrize("kernel", [kernel, without_the_lock])
def test_an_address_is_found_when_it_is_needed(kernel):
    functions = Functions(FINDER)
    functions.add(PLACE, weighted, KINDS)
    holder, words = addresses(functions)
    assert words[FINDER] != 0
    assert words[PLACE] == 0
    assert kernel(holder, 1.5, 7) == 22.5
    assert words[PLACE] == functions.address(PLACE) == addresses(functions)[1][PLACE]
    assert kernel(holder, 1.5, 7) == 22.5


class Failing(Functions):
    """Raises what it is told to, in the place of an address."""

    error: BaseException

    def address(self, place):
        raise self.error


@pytest.mark.parametrize("kernel", [kernel, without_the_lock])
def test_who_is_interrupted_while_it_is_found_gets_no_wrong_result(kernel):
    functions = Failing(FINDER)
    functions.error = KeyboardInterrupt()
    holder, words = addresses(functions)
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            kernel(holder, 1.5, 7)
        assert words[PLACE] == 0


def test_a_function_that_cannot_be_compiled_is_an_error(caplog):
    functions = Failing(FINDER)
    functions.error = MemoryError("no room for code")
    holder, _ = addresses(functions)
    with caplog.at_level(logging.ERROR, "dt3d"):
        for _ in range(2):
            with pytest.raises(InternalError, match=f"the function at {PLACE} could not be compiled"):
                kernel(holder, 1.5, 7)
    assert ["no room for code" in record.exc_text for record in caplog.records] == [True, True]

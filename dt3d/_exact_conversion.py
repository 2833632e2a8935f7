"""One conversion of numbers to float64, for arrays and files: what it would change is an error."""

from __future__ import annotations

from decimal import Decimal
from numbers import Real
from typing import SupportsIndex

import numpy as np
import numpy.typing as npt

WHOLE = 2**53  # integers up to this are float64 numbers, all of them
FLOAT64 = np.dtype(np.float64)  # in the byte order of this machine
GREATEST = "at most 1.8e308"

CURES = {
    "b": "for 0 and 1 pass {whole}.astype(np.float64)",
    "c": "if the imaginary parts are zero, pass {whole}.real",
    "U": "for the numbers in text pass {whole}.astype(np.float64)",
    "S": "for the numbers in text pass {whole}.astype(np.float64)",
    "V": "for numbers of an extension of NumPy pass np.asarray({whole}).astype(np.float64)",
    "M": "for seconds pass ({whole} - {whole}.min()) / np.timedelta64(1, 's')",
    "m": "for seconds pass {whole} / np.timedelta64(1, 's')",
}


def to_float64(array: npt.ArrayLike, what: str = "points", whole: str | None = None) -> np.ndarray:
    """The numbers as float64 of the same shape; the array itself where it is float64 already.

    What is converted is converted back and compared, so the result equals what came. NaN and infinity pass.

    Parameters
    ----------
    array : array_like
        Integers or floating-point numbers of any size, or objects that are real numbers: ints, floats,
        `decimal.Decimal`, `fractions.Fraction`, NumPy's scalars.
    what : str
        What the array is called in messages, such as "points".
    whole : str, optional
        An expression for what the caller may pass instead, if it is not the array: the table of a column.

    Raises
    ------
    ValueError
        For dtypes that are not real numbers, bool among them, and for a value that float64 does not hold
        exactly; the message names its row, its column and the value.
    """
    given = _as_array(array)
    if given.dtype == FLOAT64:
        return given
    kind = given.dtype.kind
    if kind == "O":
        return _from_objects(given, what, whole or what)
    if kind not in "iuf":
        cure = f"; {CURES[kind].format(whole=whole or what)}" if kind in CURES else ""
        msg = f"{what} must be real numbers, got dtype {given.dtype}{cure}"
        raise ValueError(msg)
    with np.errstate(all="ignore"):
        converted = given.astype(np.float64, copy=False)
    if given.dtype.itemsize >= 8 and given.size and kind + str(given.dtype.itemsize) != "f8":
        _compare(given, converted, what, whole or what)
    return converted


def _as_array(array: npt.ArrayLike) -> np.ndarray:
    """NumPy's array of what came; of objects where NumPy would round integers that lie beside floats."""
    if not isinstance(array, list | tuple):
        return np.asarray(array)
    try:
        given = np.asarray(array)
    except OverflowError:
        return np.asarray(array, object)
    if given.dtype == np.float64 and given.size and not (given.max() < WHOLE and given.min() > -WHOLE):
        return np.asarray(array, object)
    return given


def _compare(given: np.ndarray, converted: np.ndarray, what: str, whole: str) -> None:
    """Raise a ValueError where integers of 64 bits, or long doubles, differ from what they became."""
    if given.dtype.kind == "f":
        with np.errstate(all="ignore"):
            changed = (converted.astype(given.dtype) != given) & ~np.isnan(given)
    elif int(given.min()) >= -WHOLE and int(given.max()) <= WHOLE:
        return
    else:
        # 2^63 is no int64 and 2^64 no uint64: to convert them back is undefined
        fits = converted < 2.0 ** (8 * given.dtype.itemsize - (given.dtype.kind == "i"))
        changed = ~fits | (np.where(fits, converted, 0).astype(given.dtype) != given)
    if changed.any():
        index = np.unravel_index(int(np.argmax(changed)), given.shape)
        raise _inexact(given[index], float(converted[index]), _place(index), what, whole)


def _from_objects(given: np.ndarray, what: str, whole: str) -> np.ndarray:
    converted = np.empty(given.shape)
    flat = converted.reshape(-1)
    for i, value in enumerate(given.flat):
        # NumPy rounds its integers before it compares them with floats, and Python does not
        plain = int(value) if isinstance(value, np.integer) else value
        if isinstance(plain, bool | np.bool_) or not isinstance(plain, Real | Decimal):
            which = f"{_place(np.unravel_index(i, given.shape))} is {_shown(value)}"
            msg = f"{what} must be real numbers; {which}, of type {type(value).__name__}"
            if value is None and given.ndim > 1:
                msg += f"; drop such rows: pass {whole}[({whole} != None).all(axis=-1)]"
            raise ValueError(msg)
        try:
            flat[i] = number = float(plain)
        except OverflowError:
            number = np.inf
        except ValueError:  # a signalling NaN
            flat[i] = number = np.nan
        if not np.isnan(number) and number != plain:
            raise _inexact(value, number, _place(np.unravel_index(i, given.shape)), what, whole)
    return converted


def _inexact(value: object, nearest: float, place: str, what: str, whole: str) -> ValueError:
    which = f"{place} of {what} is {_shown(value)}, which"
    if np.isinf(nearest):
        return ValueError(f"{which} is too great for float64 ({GREATEST}); divide all by a power of two")
    integer = isinstance(value, int | np.integer)
    array = whole if whole.startswith("np.") else f"np.asarray({whole})"
    cure = f"{'subtract an offset, or ' if integer else ''}to round pass {array}.astype(np.float64)"
    shown = f"{int(nearest)}" if integer else f"{nearest:.20g}"
    return ValueError(f"{which} float64 does not hold exactly (the nearest is {shown}); {cure}")


def _place(index: tuple[SupportsIndex, ...]) -> str:
    if len(index) == 2:
        return f"row {index[0]}, column {index[1]}"
    if len(index) == 1:
        return f"row {index[0]}"
    return f"index {tuple(map(int, index))}" if index else "one number"


def _shown(value: object) -> str:
    """The value in full where it is a number of few digits, else its beginning and its length."""
    if isinstance(value, int) and abs(value) >= 10**40:
        return f"an integer of {value.bit_length()} bits"
    text = str(value) if isinstance(value, np.number | Real | Decimal) else repr(value)
    return text if len(text) <= 60 else f"{text[:50]}... ({len(text)} characters)"

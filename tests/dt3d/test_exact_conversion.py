"""Numbers become float64 without a change, or an error says which one cannot."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from dt3d._input import to_float64

ODD = 2**53 + 1  # the least integer that is no float64 number
LONG = np.longdouble
wider = pytest.mark.skipif(np.finfo(LONG).eps == np.finfo(float).eps, reason="long double is float64 here")


@pytest.mark.parametrize(
    "dtype", [np.int8, np.uint16, np.int32, np.uint64, np.float16, np.float32, ">f8", ">i4"]
)
def test_other_dtypes_are_converted(dtype):
    given = np.array([[0, 1, 2], [3, 100, 7]], dtype)
    converted = to_float64(given)
    assert converted.dtype == np.float64
    assert converted.dtype.isnative
    np.testing.assert_array_equal(converted, given)


def test_float64_is_handed_on_as_it_is():
    given = np.array([[1.5, np.nan, np.inf]])
    assert to_float64(given) is given


def as_fraction(x):
    return (int(x), 1) if isinstance(x, int | np.integer) else x.as_integer_ratio()


@pytest.mark.parametrize(
    "given",
    [
        np.array([[2**53, -(2**53), 3 * 2**55]]),
        np.array([[-(2**63), 2**62, 2**63 - 1024]]),
        np.array([[2**63, 2**64 - 2048, 5]], np.uint64),
        np.array([[2**70, -(2**1023), 0.25]], object),
        [[2**70, 2**55, 0.25]],
        np.array([[Decimal("0.5"), Fraction(1, 4), np.int64(7)]], object),
        np.array([[np.float32(0.1), np.float16(0.1), LONG(3)]], object),
        np.array([[LONG(2) ** 80, 0, 1]]),
    ],
    ids=lambda given: str(np.asarray(given).ravel()[0]),
)
def test_what_float64_holds_is_welcome(given):
    converted = to_float64(given)
    assert converted.dtype == np.float64
    exact = [[Fraction(*as_fraction(x)) for x in row] for row in given]
    assert [[Fraction(x) for x in row] for row in converted.tolist()] == exact


@pytest.mark.parametrize("value", [ODD, -ODD, 2**63 - 1, 2**62 + 1], ids=str)
@pytest.mark.parametrize(
    "kind", [np.int64, np.uint64, object, "int64 in object", "list", "list beside floats"]
)
def test_an_integer_between_float64_numbers_is_named(value, kind):
    if kind is np.uint64:
        value = abs(value)
    rows = [[0, 0, 0], [0, 0, value]]
    if kind == "int64 in object":
        rows[1][2] = np.int64(value)
        given = np.array(rows, object)
    elif kind == "list beside floats":
        rows[0][0] = 0.5
        given = rows
    else:
        given = rows if kind == "list" else np.array(rows, kind)
    message = rf"row 1, column 2 of points is {value}, .*exactly \(the nearest is {int(float(value))}\)"
    with pytest.raises(ValueError, match=message):
        to_float64(given)


def test_the_greatest_uint64_is_named():
    # its nearest float64 number, 2^64, is none that could be converted back
    with pytest.raises(ValueError, match="row 2 of counts is 18446744073709551615, which"):
        to_float64(np.array([0, 1, 2**64 - 1], np.uint64), "counts")


@wider
@pytest.mark.parametrize("dtype", [LONG, object])
def test_a_long_double_between_float64_numbers_is_named(dtype):
    given = np.array([[1, 2, 3], [1, LONG(1) / 3, 3]], dtype)
    with pytest.raises(
        ValueError, match=r"row 1, column 1 of points is 0.3333333333333333333.*float64 does not"
    ):
        to_float64(given)
    np.testing.assert_array_equal(to_float64(np.asarray(given).astype(np.float64)), given.astype(float))


@wider
def test_a_long_double_beyond_float64_is_not_called_infinity():
    given = np.array([[1, 2, 3], [1, LONG("1e4000"), 3]])
    with pytest.raises(
        ValueError, match=r"row 1, column 1 of points is 1e\+4000, which is too great for float64"
    ):
        to_float64(given)
    assert np.isinf(to_float64(np.array([LONG("inf")]))).all()
    assert np.isnan(to_float64(np.array([LONG("nan")]))).all()
    with pytest.raises(ValueError, match="is 1e-4000, which float64 does not hold exactly"):
        to_float64(np.array([LONG("1e-4000")]))


@pytest.mark.parametrize(
    "value", [10**400, Decimal("1e400"), Fraction(10**400, 7)], ids=["int", "Decimal", "Fraction"]
)
@pytest.mark.parametrize("beside", [0, 0.5])
def test_an_object_beyond_float64_is_too_great(value, beside):
    for given in ([[beside, value]], np.array([[beside, value]], object)):
        with pytest.raises(
            ValueError, match="row 0, column 1 of points is .*too great for float64"
        ) as caught:
            to_float64(given)
        assert len(str(caught.value)) < 200


@pytest.mark.parametrize("value", [Decimal("0.1"), Fraction(1, 3)])
def test_a_fraction_that_float64_rounds_is_named(value):
    with pytest.raises(ValueError, match=rf"row 0 of points is {value}, which float64 does not hold exactly"):
        to_float64(np.array([value]))


@pytest.mark.parametrize("value", [None, True, np.True_, "1.5", 1j, [1], object])
def test_an_object_that_is_no_number_is_named(value):
    given = np.zeros((4, 3), object)
    given[2, 1] = value
    with pytest.raises(
        ValueError, match=r"row 2, column 1 is .*, of type (NoneType|bool|str|complex|list|type)"
    ):
        to_float64(given)


def test_nan_objects_pass():
    given = np.array([float("nan"), Decimal("nan"), Decimal("snan"), Decimal("inf"), -np.inf], object)
    np.testing.assert_array_equal(to_float64(given), [np.nan, np.nan, np.nan, np.inf, -np.inf])


def test_nothing_depends_on_how_numpy_reports_floating_point_errors():
    with np.errstate(all="raise"):
        assert to_float64(np.array([[2**60, 1]])).tolist() == [[2.0**60, 1.0]]
        assert np.isnan(to_float64(np.array([np.nan], np.float32))).all()
        with pytest.raises(ValueError, match="too great|does not hold"):
            to_float64(np.array([np.finfo(LONG).max, LONG(1) / 3]))


@pytest.mark.parametrize(
    "given",
    [np.array([[ODD, ODD + 2]]), np.array([[ODD, ODD + 2]], object), np.array([[Decimal(1) / 3, 7]])],
    ids=["int64", "object", "Decimal"],
)
def test_the_cures_of_inexact_numbers_work(given):
    with pytest.raises(ValueError, match="which float64 does not hold exactly") as caught:
        to_float64(given)
    assert "to round pass np.asarray(points).astype(np.float64)" in str(caught.value)
    assert to_float64(np.asarray(given).astype(np.float64)).shape == (1, 2)
    if "subtract an offset" in str(caught.value):
        assert to_float64(given - given.min()).tolist() == [[0, 2]]


@pytest.mark.parametrize(
    ("given", "cure"),
    [
        (np.array([True, False]), lambda points: points.astype(np.float64)),
        (np.array([1 + 0j, 2]), lambda points: points.real),
        (np.array(["1.5", "2"]), lambda points: points.astype(np.float64)),
        (np.array([b"1.5", b"2"]), lambda points: points.astype(np.float64)),
        (
            np.array(["2020-01-01", "2020-01-03"], "M8[D]"),
            lambda points: (points - points.min()) / np.timedelta64(1, "s"),
        ),
        (np.array([3, 5], "m8[D]"), lambda points: points / np.timedelta64(1, "s")),
    ],
    ids=lambda given: str(given.dtype) if isinstance(given, np.ndarray) else "",
)
def test_the_cures_of_other_dtypes_work(given, cure):
    with pytest.raises(
        ValueError, match=f"points must be real numbers, got dtype {given.dtype}".replace("[", r"\[")
    ):
        to_float64(given)
    assert to_float64(cure(given)).shape == given.shape

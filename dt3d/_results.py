"""Results that stay as they were computed, so that compiled code can rely on them.

Compiled code indexes without a check. What it reads is therefore checked where it comes in, from a method of
this package or from a pickle, and cannot change afterwards.
"""

from __future__ import annotations

import inspect
from functools import cached_property
from typing import Any, ClassVar, NoReturn, Self

import numpy as np
import numpy.typing as npt

from ._topology import OUTSIDE

Names = tuple[str, ...]
SIMPLICES = ("simplices", "triangles", "neighbors", "iteration", "thread", "convex_hull")


def frozen(array: np.ndarray) -> np.ndarray:
    """The array, in C order, as one that is read-only for good, without a copy where it is in C order.

    Not only the flag is off: the base is a read-only buffer, so NumPy refuses to set it again.
    """
    if not array.flags.writeable and isinstance(array.base, memoryview) and array.flags.c_contiguous:
        return array
    buffer: Any = np.ascontiguousarray(array)
    return np.asarray(memoryview(buffer).toreadonly())


class Result:
    """A base of triangulations: read-only arrays and attributes, and pickles that are checked."""

    _arrays: ClassVar[Names] = ()
    """Names of the arrays that a pickle has to have."""
    _others: ClassVar[Names] = ()
    """Names of what it has to have beside them."""
    _derived: ClassVar[Names] = ()
    """Names of all properties: computed when asked for, and in no pickle."""

    def __init_subclass__(cls) -> None:
        """Note the properties of the class and of those it is made from."""
        super().__init_subclass__()
        kinds = (property, cached_property)
        cls._derived = tuple(n for n in dir(cls) if isinstance(inspect.getattr_static(cls, n), kinds))

    @classmethod
    def _arrays_of(cls, state: dict[str, object]) -> Names:
        """The names of the arrays that a result with these attributes has to have."""
        return cls._arrays

    def _keep(self, **results: object) -> None:
        """Set results, once they are what they will be; arrays become read-only."""
        for name in self.__dict__.keys() & self._derived:  # of other results, if there were any
            del self.__dict__[name]
        for name, value in results.items():
            self.__dict__[name] = frozen(value) if isinstance(value, np.ndarray) else value

    def __setattr__(self, name: str, value: object) -> None:
        """Refuse to replace a result; attributes of the user's own are fine."""
        self._refuse(name, "assigned")
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> None:
        """Refuse to delete a result."""
        self._refuse(name, "deleted")
        super().__delattr__(name)

    def _refuse(self, name: str, what: str) -> None:
        if name not in self._arrays_of(self.__dict__) + self._others + self._derived:
            return  # an attribute of the user's own
        cure = f"tri.{name}.copy() is an array to change"
        if name == "points":
            cure += "; for other sites make a new triangulation, as of points[keep]"
        elif name in SIMPLICES:
            cure += "; tri.subset(keep) is a part of the triangulation"
        elif not isinstance(self.__dict__.get(name), np.ndarray):
            cure = "make a new triangulation"
        msg = f"{name} cannot be {what}: results stay as they were computed; {cure}"
        raise AttributeError(msg)

    def __getstate__(self) -> dict[str, object]:
        """What a pickle has: all but what can be computed again."""
        return {name: value for name, value in self.__dict__.items() if name not in self._derived}

    def __setstate__(self, state: dict[str, object]) -> None:
        """Restore what a pickle has, checked as if it came from a stranger.

        Raises
        ------
        ValueError
            If something is missing, of a wrong kind or shape, or an index is out of range.
        """
        names = self._arrays_of(state)
        missing = set(names + self._others) - set(state)
        if missing:
            damaged(f"there is no {', '.join(sorted(missing))}")
        arrays: dict[str, np.ndarray] = {}
        for name in names:
            array = state[name]
            if not isinstance(array, np.ndarray) or not array.ndim:
                damaged(f"{name} is no array")
            # a buffer that came beside the pickle may be changed by its owner
            arrays[name] = array if _in_bytes(array) else array.copy()
        self._check(arrays)
        self._keep(**{name: state[name] for name in state.keys() - set(self._derived)} | arrays)

    def _check(self, own: dict[str, np.ndarray]) -> None:
        """Raise a ValueError unless the arrays are those of a triangulation."""
        raise NotImplementedError

    def __copy__(self) -> Self:
        """Share the arrays, which nobody changes."""
        copy = type(self).__new__(type(self))
        copy.__dict__.update(self.__dict__)
        return copy


def check_complex(
    points: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray, dimension: int | None = None
) -> None:
    """Raise a ValueError unless compiled code can walk in these arrays: kinds, shapes, ranges, finite sites.

    Parameters
    ----------
    points : float64 (n, d)
        Sites.
    simplices, neighbors : int32 (m, d + 1)
        Rows of points, and of simplices or -1.
    dimension : 2 or 3
        d; that of the points if left out.
    """
    d = dimension or (points.shape[1] if points.ndim == 2 else 3)
    check_array("points", points, np.float64, (len(points), d))
    if not np.isfinite(points).all():
        damaged("points are not finite")
    for name, array in (("simplices", simplices), ("neighbors", neighbors)):
        check_array(name, array, np.int32, (len(simplices), d + 1))
    check_range("simplices", simplices, 0, len(points))
    check_range("neighbors", neighbors, OUTSIDE, len(simplices))


def check_array(name: str, array: np.ndarray, dtype: npt.DTypeLike, shape: tuple[int, ...]) -> None:
    """Raise a ValueError unless the array is of this dtype, in the machine's byte order, and shape."""
    if array.dtype != dtype or array.shape != shape:
        damaged(f"{name} are {array.dtype} of shape {array.shape}, not {np.dtype(dtype)} of {shape}")


def check_range(name: str, array: np.ndarray, least: int, end: int) -> None:
    """Raise a ValueError unless least <= index < end for each index of the array."""
    if array.size and (array.min() < least or array.max() >= end):
        damaged(f"{name} go from {array.min()} to {array.max()}, not within {least} to {end - 1}")


def damaged(what: str) -> NoReturn:
    """Raise the ValueError for arrays that are no triangulation."""
    msg = f"these arrays are no triangulation of dt3d, or were changed: {what}"
    raise ValueError(msg)


def _in_bytes(array: np.ndarray) -> bool:
    """Whether the array lies in a bytes object, which nobody can change."""
    base: Any = array
    while isinstance(base, np.ndarray):
        base = base.base
    return isinstance(base.obj if isinstance(base, memoryview) else base, bytes)

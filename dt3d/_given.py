"""What users pass as points, as an array: lists, masked arrays, tables, meshes. Errors tell the way out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Sized
from os import PathLike
from typing import Any, Protocol, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from ._exact_conversion import to_float64


class HasPoints(Protocol):
    """A dataset of PyVista, a mesh of meshio, a triangulation: what has the points as an attribute."""

    @property
    def points(self) -> np.ndarray:
        """Coordinates (n, d)."""


PointsLike: TypeAlias = npt.ArrayLike | HasPoints  # what `as_numbers` takes, to type checkers

AXES = "xyz"


def as_numbers(given: object, name: str, dimension: int | None) -> tuple[np.ndarray, str]:
    """The array that was given, not yet float64 and of any shape, and an expression for it in messages.

    Parameters
    ----------
    given : object
        An array, what NumPy makes an array of, a masked array with nothing masked, a structured array with
        fields x, y and z, a table (of pandas, for example), or an object with an attribute ``points``, as
        datasets of PyVista and meshes of meshio have.
    name : str
        What the caller calls it.
    dimension : 2, 3 or None
        How many coordinates are wanted; None: as many as there are, two or three.

    Raises
    ------
    ValueError
        If it is masked in places, a file's name, ragged, or nothing of the kind.
    """
    if isinstance(given, np.ma.MaskedArray):
        return as_numbers(_unmasked(given, name), name, dimension)
    if isinstance(given, np.ndarray):
        if given.dtype.names:
            return _fields(given, name, dimension)
        if given.dtype.kind == "O" and given.ndim == 1 and all(_is_row(row) for row in given):
            return as_numbers(list(given), f"np.stack({name})", dimension)
        return given, name
    if isinstance(given, list | tuple):
        return _rows(given, name, dimension), f"np.asarray({name})"
    if isinstance(given, str | bytes | PathLike):
        reader = "read_points(path, dimension=2)" if dimension == 2 else "read_points(path)"
        msg = f"{name} must be numbers, got {given!r}; for a file pass dt3d.files.{reader}"
        raise ValueError(msg)
    if isinstance(given, Mapping):
        columns = ", ".join(f"{name}[{key!r}]" for key in list(given)[: dimension or 3])
        msg = f"{name} must be an array, got a {type(given).__name__}; pass np.column_stack([{columns}])"
        raise ValueError(msg)
    if hasattr(given, "to_numpy") and hasattr(given, "columns") and len(np.shape(cast(Any, given))) == 2:
        return _table(given, name, dimension), f"{name}.to_numpy().astype(np.float64)"
    points: Any = getattr(given, "points", 0)
    if np.ndim(points) == 2:
        return as_numbers(points, f"{name}.points", dimension)
    _refuse_vtk(given, name)
    return _made(given, name), f"np.asarray({name})"


def _refuse_vtk(given: object, name: str) -> None:
    """Say of what VTK and PyVista have beside datasets with an array of points how to come by these."""
    kind = type(given).__name__
    if hasattr(given, "n_blocks") and hasattr(given, "combine"):
        blocks: Any = given.n_blocks
        msg = f"{name} must be one array or dataset, got a {kind} of {blocks} datasets; pass {name}.combine()"
        raise ValueError(msg)
    if hasattr(given, "GetNumberOfPoints") and hasattr(given, "GetPoints"):
        msg = f"{name} must be an array or a dataset of PyVista, got a {kind}; pass pyvista.wrap({name})"
        raise ValueError(msg)


def _made(given: object, name: str) -> np.ndarray:
    """NumPy's array of an object of another library."""
    try:
        array = np.asarray(given)
    except Exception as error:  # tensors on other devices raise TypeError, others RuntimeError
        reason = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
        msg = f"{name} of type {type(given).__name__} cannot be made a NumPy array: {reason}"
        raise ValueError(msg) from error
    if array.dtype.kind == "O" and not array.ndim:
        msg = f"{name} must be an array of numbers, got a {type(given).__name__}"
        if hasattr(given, "__iter__"):
            msg += f"; pass list({name})"
        raise ValueError(msg)
    return array


def _rows(given: Sequence[object], name: str, dimension: int | None) -> np.ndarray:
    if any(isinstance(row, np.ma.MaskedArray) for row in given):  # np.asarray would drop their masks
        return np.asarray(_unmasked(np.ma.array(given), f"np.ma.array({name})"))
    try:
        return np.asarray(given)
    except OverflowError:  # a great integer beside floats
        return np.asarray(given, object)
    except (ValueError, TypeError) as error:
        lengths = [len(cast(Sized, row)) if _is_row(row) else 0 for row in given]
        odd = next((i for i, length in enumerate(lengths) if length != lengths[0]), None)
        where = str(error) if odd is None else f"row {odd} has {lengths[odd]} numbers, row 0 has {lengths[0]}"
        msg = (
            f"{name} must be an array of shape (n, {dimension or '2 or 3'}); the rows that came do not have "
            f"one length: {where}"
        )
        raise ValueError(msg) from None


def _is_row(row: object) -> bool:
    return isinstance(row, list | tuple) or (isinstance(row, np.ndarray) and row.ndim > 0)


def _unmasked(given: np.ma.MaskedArray, name: str) -> np.ndarray:
    """The data of a masked array with nothing masked."""
    mask = np.ma.getmaskarray(given)
    if given.dtype.names:
        cure = f"{name}[[not any(row) for row in np.ma.getmaskarray({name})]]"
        rows: list[Any] = mask.ravel().tolist()
        masked = sum(any(row) for row in rows)
    else:
        cure = f"{name}[~np.ma.getmaskarray({name}).any(axis=-1)]"
        masked = int(mask.any(axis=-1).sum())
    if masked:
        msg = f"{name} are a masked array, and {masked} rows are masked in places; drop these: pass {cure}"
        raise ValueError(msg)
    return given.data


def _fields(given: np.ndarray, name: str, asked: int | None) -> tuple[np.ndarray, str]:
    """The columns x, y (and z) of a structured array (n,)."""
    fields = given.dtype.names or ()
    called = {field.lower(): field for field in fields}
    dimension = asked or (2 if {"x", "y"} <= called.keys() and "z" not in called else 3)
    wanted = [called[axis] for axis in AXES[:dimension] if axis in called]
    if len(wanted) < dimension or given.ndim != 1:
        found = ", ".join(fields)
        columns = ", ".join(f"{name}[{field!r}]" for field in fields[:dimension])
        msg = (
            f"{name} are a structured array of shape {given.shape} with the fields {found}; what is read is "
            f"{', '.join(AXES[:dimension])} of shape (n,). For other fields pass np.column_stack([{columns}])"
        )
        raise ValueError(msg)
    if dimension == 2 and "z" in called:
        msg = (
            f"{name} have a field {called['z']}, and a triangulation in the plane needs x and y alone; for "
            f"points in space use dt3d.Delaunay, without {called['z']} pass {name}[{wanted!r}]"
        )
        raise ValueError(msg)
    names = [f"{name}[{field!r}]" for field in wanted]
    whole = f"np.column_stack([{', '.join(names)}])"
    return np.column_stack([to_float64(given[f], f"{name}[{f!r}]", whole) for f in wanted]), whole


def _table(
    given: Any,  # a table of any library
    name: str,
    asked: int | None,
) -> np.ndarray:
    """The columns of a table, each converted by itself: together they could be rounded."""
    labels = list(given.columns)
    dimension = asked or (2 if len(labels) == 2 else 3)
    if len(labels) != dimension:
        names = {str(label).lower(): label for label in labels}
        wanted = [names[axis] for axis in AXES[:dimension] if axis in names]
        cure = f"; pass {name}[{wanted!r}]" if len(wanted) == dimension else ""
        if dimension == 3 and len(labels) == 2:
            cure = "; for points in the plane use dt3d.Delaunay"
        count, came = dimension if asked else "2 or 3", ", ".join(map(str, labels))
        msg = f"{name} must have {count} columns, got {len(labels)}: {came}{cure}"
        raise ValueError(msg)
    columns = []
    for k, label in enumerate(labels):
        column = given.iloc[:, k] if hasattr(given, "iloc") else given[label]
        columns.append(_column(column, f"{name}[{label!r}]", name))
    return np.column_stack(columns)


def _column(
    column: Any,  # of such a table
    name: str,
    table: str,
) -> np.ndarray:
    values = column.to_numpy()
    if hasattr(column, "isna"):  # of pandas, whose missing values are of several kinds
        missing = np.flatnonzero(np.asarray(column.isna(), bool)).tolist()
    else:
        missing = [i for i, x in enumerate(values) if x is None] if values.dtype.kind == "O" else []
    if missing:
        msg = f"row {missing[0]} of {name} has no value, NaN or NA; drop such rows: pass {table}.dropna()"
        raise ValueError(msg)
    return to_float64(values, name, table)

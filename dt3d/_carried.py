"""What a mesh file holds of the data of its points: numbers, anything, or nothing."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

HOLD_NUMBERS = (".vtu", ".vtp", ".vtk", ".msh")
HOLD_ANYTHING = (".npz",)
OF_GMSH = (1, 3, 9)
"""Numbers per point: Gmsh knows scalars, vectors and tensors."""

MOST_NAMES = 12
"""Of one reason, in a message."""

KINDS = {"U": "text", "S": "bytes", "c": "complex numbers", "m": "times", "M": "times"}
"""What the kinds of NumPy's types that are no real numbers are called."""


def carried(
    point_data: Mapping[str, np.ndarray], extension: str
) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """The point data that a format holds, and why it does not hold the others.

    Parameters
    ----------
    point_data : mapping of str to arrays (n, ...)
        Data by name.
    extension : str
        Such as ``.vtu``, in any case.

    Returns
    -------
    dict of str to arrays
        Those that `write_mesh` can write into such a file.
    dict of str to str
        The names of the others, with the reason.
    """
    kept, left_out = {}, {}
    for name, values in point_data.items():
        why = _obstacle(np.asarray(values), extension.lower())
        if why:
            left_out[name] = why
        else:
            kept[name] = values
    return kept, left_out


def said(left_out: Mapping[str, str]) -> str:
    """A line that lists what was left out, and why; empty if nothing was."""
    reasons: dict[str, list[str]] = {}
    for name, why in left_out.items():
        reasons.setdefault(why, []).append(name)
    parts = []
    for why, names in reasons.items():
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        parts.append(f"{', '.join(names[:MOST_NAMES])}{more} ({why})")
    return "point data left out: " + "; ".join(parts) if parts else ""


def _obstacle(values: np.ndarray, extension: str) -> str:
    """Why a format does not hold an array; empty if it does."""
    if extension in HOLD_ANYTHING:
        return ""
    if extension not in HOLD_NUMBERS:
        return f"{extension} holds no point data"
    if values.dtype.kind not in "biuf":
        return f"{extension} holds numbers only, and this is {KINDS.get(values.dtype.kind, values.dtype)}"
    width = int(np.prod(values.shape[1:]))
    if not width:
        return "it has no numbers"
    if extension == ".msh":
        if width not in OF_GMSH:
            return f".msh holds 1, 3 or 9 numbers per point, and this has {width}"
        if values.dtype.kind in "iu" and (values.astype(np.float64).astype(values.dtype) != values).any():
            return ".msh holds double precision, and these integers are greater"
    return ""

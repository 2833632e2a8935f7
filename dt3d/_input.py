"""The input contract: what is accepted as sites, and what the errors say."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._errors import DegenerateInputError
from ._exact_conversion import to_float64 as to_float64
from ._given import PointsLike, as_numbers

# Indices of faces (four per tetrahedron, some seven tetrahedra per site) are int32.
MOST_SITES = 2**25


def check_points(
    points: PointsLike, dimension: int | None = None, *, may_be_empty: bool = False
) -> np.ndarray:
    """The points as a float64 array of its own, in C order, of shape (n, dimension).

    Without a dimension it is what the points have, 2 or 3.

    Raises
    ------
    ValueError
        If they are not numbers that float64 holds exactly, not of shape (n, dimension), empty, masked in
        places, not finite, or too many. The message says what to do about it.
    """
    given, name = as_numbers(points, "points", dimension)
    if may_be_empty and given.shape == (0,):
        given = given.reshape(0, dimension or 2)
    if given.ndim != 2 or given.shape[1] not in ((2, 3) if dimension is None else (dimension,)):
        raise _shape_error(given, name, dimension)
    if not len(given) and not may_be_empty:
        least = {2: "three", 3: "four"}[given.shape[1]]
        msg = f"points are empty; a triangulation needs at least {least} sites"
        raise ValueError(msg)
    if len(given) > MOST_SITES:
        msg = f"at most 2^25 = {MOST_SITES} sites can be numbered, got {len(given)}"
        raise ValueError(msg)
    # a copy, since what was given may change; in C order, since every other order is another type to numba
    array = np.array(to_float64(given, name), order="C")
    _check_finite(array, "points", _of_numbers(given, name))
    return array


def check_queries(xi: npt.ArrayLike, dimension: int) -> tuple[np.ndarray, tuple[int, ...]]:
    """Points to be located, as float64 (k, dimension), and the shape of the answers. There may be any number.

    They need not be finite, as in SciPy.

    Raises
    ------
    ValueError
        If they are not real and of shape (..., dimension).
    """
    given, name = as_numbers(xi, "xi", dimension)
    if not given.ndim or given.shape[-1] != dimension:
        msg = f"xi, points to be located, must have shape (..., {dimension}), got {given.shape}"
        if given.ndim == 2 and given.shape[0] == dimension:
            msg += f"; it looks transposed: pass {name}.T"
        raise ValueError(msg)
    array = to_float64(given, name)
    return array.reshape(-1, dimension), given.shape[:-1]


def _of_numbers(given: np.ndarray, name: str) -> str:
    return f"{name}.astype(np.float64)" if given.dtype.kind == "O" else name


def _check_finite(array: np.ndarray, what: str, whole: str) -> None:
    if np.isfinite(array).all():
        return
    rows = np.isfinite(array).all(axis=-1)
    first = np.argwhere(~rows)[0].tolist() if rows.ndim else []
    which = f"row {first[0]}" if len(first) == 1 else f"index {tuple(first)}"
    count = np.count_nonzero(~rows)
    msg = f"{what} must be finite: {count} rows have NaN or infinity, the first is {which}"
    if rows.ndim:
        msg += f"; drop such rows: pass {whole}[np.isfinite({whole}).all(axis=-1)]"
    raise ValueError(msg)


def _shape_error(given: np.ndarray, name: str, dimension: int | None) -> ValueError:
    """The error for points of a wrong shape, with the way out where one is likely."""
    shape, cure = given.shape, ""
    served = (2, 3) if dimension is None else (dimension,)
    if given.dtype.kind in "US" and not given.ndim:
        cure = "; for a file pass dt3d.files.read_points(path)"
    elif len(shape) == 2 and shape[0] in served and shape[1] > max(served):
        cure = f"; it looks transposed: pass {name}.T"
    elif len(shape) == 2 and dimension == 3 and shape[1] == 2:
        cure = "; for points in the plane use dt3d.Delaunay"
    elif len(shape) == 2 and dimension == 2 and shape[1] == 3:
        cure = f"; for points in space use dt3d.Delaunay, without the third coordinate pass {name}[:, :2]"
    elif len(shape) == 2 and shape[1] > max(served):
        first = f"{name}[:, :{max(served)}]"
        cure = (
            f"; if the first columns are the coordinates, pass {first}. For more dimensions there is "
            "scipy.spatial.Delaunay"
        )
    elif len(shape) == 2:
        cure = "; sites on a line have no simplices to find: np.sort orders them"
    else:
        fits = [
            d
            for d in served
            if (len(shape) > 2 and shape[-1] == d) or (len(shape) == 1 and shape[0] % d == 0)
        ]
        if given.size and len(fits) == 1:
            cure = f"; pass {name}.reshape(-1, {fits[0]})"
        elif given.size and fits:
            cure = f"; pass {name}.reshape(-1, 3), or {name}.reshape(-1, 2) in the plane"
    wanted = " or ".join(f"(n, {d})" for d in served)
    came = f"{shape}, {len(shape)} dimensions" if len(shape) > 2 else f"{shape}"
    return ValueError(f"points must have shape {wanted}, got {came}{cure}")


def check_seed(seed: object) -> int:
    """The seed as a Python integer, of any size.

    Raises
    ------
    ValueError
        If it is no integer, bool included, or negative.
    """
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        msg = f"seed must be an integer that is not negative, of any size, got {seed!r}"
        raise ValueError(msg)
    return int(seed)


def word_of(seed: int) -> int:
    """A seed of any size as one below 2^63, which compiled code takes; those below stay as they are."""
    if seed < 2**63:
        return seed
    return int(np.random.SeedSequence(seed).generate_state(1, np.uint64)[0] >> np.uint64(1))


def first_copies(sites: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the distinct sites, and pairs (a later copy, the first one): int (m,) and int32 (k, 2).

    The first of equal sites is the one of least index. The distinct sites come in the lexicographic order of
    their coordinates, the pairs in that of the copies.
    """
    order = np.lexsort(sites.T[::-1])
    ordered = sites[order]
    new = np.ones(len(sites), bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # lexsort is stable, so the first of a run of equal sites has the least index
    first = order[new][np.cumsum(new) - 1]
    copies = np.column_stack([order[~new], first[~new]]).astype(np.int32)
    return order[new], copies[np.argsort(copies[:, 0])]


def affine_dimension(sites: np.ndarray, tolerance: float) -> int:
    """0, 1, 2 or 3: of the affine hull of sites (n, 3) in the unit cube, up to ``tolerance``."""
    offset = sites - sites[0]
    direction = offset[np.argmax((offset**2).sum(axis=1))]
    length = np.linalg.norm(direction)
    if length == 0:
        return 0
    beside = np.cross(offset, direction / length)
    widest = np.argmax((beside**2).sum(axis=1))
    width = np.linalg.norm(beside[widest])
    if width <= tolerance:
        return 1
    return 2 if np.abs(offset @ (beside[widest] / width)).max() <= tolerance else 3


def check_volume(sites: np.ndarray, tolerance: float) -> None:
    """Raise DegenerateInputError unless distinct sites (n, 3) in the unit cube span a volume."""
    dimension = affine_dimension(sites, tolerance)
    if dimension == 3:
        return
    raise no_volume(dimension, len(sites))


def no_volume(dimension: int, n: int) -> DegenerateInputError:
    """The error for n distinct sites whose affine hull has the given dimension, 0, 1 or 2."""
    where = ["coincide", "lie on a line", "lie on a plane"][dimension]
    msg = (
        f"a 3D triangulation needs four sites that do not lie on a plane; the {n} distinct sites "
        f"that came {where} (dimension {dimension})"
    )
    if dimension == 2:
        msg += (
            "; for a triangulation in the plane pass two coordinates, points[:, :2], or other two columns "
            "where these are on a line"
        )
    return DegenerateInputError(msg, dimension)


def advised(error: DegenerateInputError, given: object) -> DegenerateInputError:
    """The error of `no_volume` for what was given, which may have to be indexed otherwise than an array."""
    _, name = as_numbers(given, "points", None)
    message = str(error).replace("coordinates, points[:, :2]", f"coordinates, {name}[:, :2]")
    return DegenerateInputError(message, error.dimension)


def no_area(dimension: int, n: int) -> DegenerateInputError:
    """The error for n distinct sites in the plane whose affine hull has the given dimension, 0 or 1."""
    msg = (
        f"a 2D triangulation needs three sites that do not lie on a line; the {n} distinct sites "
        f"that came {['coincide', 'lie on a line'][dimension]} (dimension {dimension})"
    )
    return DegenerateInputError(msg, dimension)


def exactly_scaled(sites: np.ndarray) -> np.ndarray:
    """Sites times a power of two, float64 (n, d): the greatest coordinate is about 1, where that is exact.

    Elsewhere, where coordinates are more than 2^1000 apart in magnitude, the sites themselves.
    """
    from .predicates import scaled

    return scaled(sites)

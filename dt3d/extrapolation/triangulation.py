"""From points to their triangulation: what happens before and after the main loop, in both modes.

Teng et al. 1993, section 5.1: with ``robustness="perturb"`` the sites are normalised to the unit cube and
perturbed in the working precision; what the consistency check cannot see is counted at the end. In the exact
mode the loop gets the sites as they are, in lexicographic order; many that fill space evenly get the compiled
steps, on a `scanvec.Device`.
"""

from __future__ import annotations

import warnings
from functools import partial

import numpy as np

import scanvec as sv

from .._errors import InconsistencyWarning
from .._input import affine_dimension, check_volume, exactly_scaled, first_copies
from .._memory import require
from . import compiled
from .consistency import count_faults
from .exact.canonical import in_canonical_order
from .exact.expander import Exact
from .exact.sites import check_magnitudes
from .expansion import PERTURBED, Perturbed
from .loop import extrapolate
from .outcome import Outcome, Report
from .perturbation import normalise, perturb
from .search_options import DEFAULT_SEARCH, SearchOptions
from .whole_boxes import WHOLE_BOXES

CLEARLY_THICK = 1e-6  # an extent, relative to the largest, that rounding cannot make
BYTES_PER_SITE = 1500  # at least, as measured
CALLER = 3  # the frames between what warns here and the caller of the public class


def triangulate(
    points: np.ndarray,
    machine: sv.Machine,
    *,
    exact: bool,
    dtype: np.dtype,
    seed: int,
    report: Report | None = None,
    options: SearchOptions = DEFAULT_SEARCH,
) -> Outcome:
    """Triangulate checked points (n, 3); vertices of the result are rows of these.

    Parameters
    ----------
    points : ndarray of float64 (n, 3)
        Finite; some may be equal.
    machine : scanvec.Machine
        Where the vectors live.
    exact : bool
        Whether sites are taken as they are; otherwise they are perturbed.
    dtype : numpy.dtype
        The working precision of perturbed sites.
    seed : int
        Of the perturbation.
    report : callable, optional
        Called as ``report(iteration, open_faces, tetrahedra)`` after every iteration.
    options : SearchOptions
        Of cells and their search. Other than the default ones go through vectors.

    Raises
    ------
    DegenerateInputError
        If all sites lie on a plane, a line or a point.
    InconsistencyError
        If the perturbation does not decide enough to finish.
    InternalError
        If exact decisions contradict each other.
    MemoryError
        If the system does not have the memory.
    ValueError
        If ``exact``, and differences of coordinates are too small beside the greatest of these.
    """
    if exact:
        used, duplicates = first_copies(points)
        out = _extrapolate_exactly(exactly_scaled(points[used]), machine, report, options)
    else:
        sites, used, duplicates = _perturbed(points, dtype, seed, options.eta)
        _require_memory(len(sites))
        mode = partial(Perturbed, spec=WHOLE_BOXES if options.whole_boxes else PERTURBED)
        out = extrapolate(machine, sites, mode, report, options)
    out.simplices = used[out.simplices].astype(np.int32)
    out.duplicates = duplicates
    if not exact:
        out.inconsistencies += count_faults(points, used, out)
    if out.inconsistencies:
        msg = (
            f"the triangulation has {out.inconsistencies} inconsistencies: tetrahedra that contradict others "
            f"were left out, so it may have holes or overlaps. Use method='insertion' (exact), "
            f"dtype='float64', or another seed"
        )
        warnings.warn(msg, InconsistencyWarning, stacklevel=CALLER)
    return out


def _extrapolate_exactly(
    sites: np.ndarray, machine: sv.Machine, report: Report | None, options: SearchOptions
) -> Outcome:
    _check_span(sites)
    _require_memory(len(sites))
    check_magnitudes(sites)
    if isinstance(machine, sv.Device) and options == DEFAULT_SEARCH and compiled.serves(sites):
        return in_canonical_order(compiled.extrapolate(machine, sites, report))
    return in_canonical_order(extrapolate(machine, sites, partial(Exact, sites=sites), report, options))


def _require_memory(n: int) -> None:
    require(f"the extrapolation of {n} sites", BYTES_PER_SITE * n)


def _check_span(sites: np.ndarray) -> None:
    """Raise DegenerateInputError unless distinct sites (n, 3) span a volume, however thin; exactly."""
    if affine_dimension(normalise(sites), CLEARLY_THICK) < 3:
        from .._first_tetrahedron import first_tetrahedron

        first_tetrahedron(sites, 0)


def _perturbed(
    points: np.ndarray, dtype: np.dtype, seed: int, eta: float | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Distinct sites, normalised and perturbed; their indices among the points; and the duplicates."""
    used, duplicates = first_copies(points)
    used.sort()  # buckets have an order of their own; this one shows in the rows of the result
    distinct = normalise(points[used])
    # sixteen times what rounding the coordinates can do to a plane
    check_volume(distinct, 16 * float(np.finfo(dtype).eps))
    sites = perturb(distinct, dtype, seed, eta)
    kept, merged = first_copies(sites)
    kept.sort()
    if len(merged):
        msg = (
            f"{len(merged)} sites differ from others by less than {dtype} resolves in the extent of the set; "
            f"they are listed in `duplicates`"
        )
        warnings.warn(msg, InconsistencyWarning, stacklevel=CALLER + 1)
        pairs = np.concatenate([duplicates, used[merged].astype(np.int32)])
        # a copy of a site that was merged is a copy of what that was merged into
        final = np.arange(len(points), dtype=np.int32)
        final[pairs[:, 0]] = pairs[:, 1]
        duplicates = np.column_stack([pairs[:, 0], final[pairs[:, 1]]])
        duplicates = duplicates[np.argsort(duplicates[:, 0])].astype(np.int32)
    return np.ascontiguousarray(sites[kept]), used[kept], duplicates

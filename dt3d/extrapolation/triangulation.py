"""From points to their triangulation: what happens before and after the main loop.

Teng et al. 1993, section 5.1: with ``robustness="perturb"`` the sites are normalised to the unit cube and
perturbed in the working precision; what the consistency check cannot see is counted at the end. In the exact
mode the loop gets the sites as they are, in lexicographic order.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np

import scanvec as sv

from .. import _topology
from .._errors import InconsistencyError, InconsistencyWarning
from .._input import affine_dimension, check_volume, exactly_scaled, first_copies
from .loop import extrapolate
from .outcome import Outcome
from .perturbation import normalise, perturb

CLEARLY_THICK = 1e-6  # an extent, relative to the largest, that rounding cannot make
# The frames between what warns here and the caller of the public class.
CALLER = 4


def triangulate(
    points: np.ndarray,
    machine: sv.Machine,
    *,
    exact: bool,
    dtype: np.dtype,
    seed: int,
    report: Callable[[int, int, int], None] | None = None,
) -> Outcome:
    """Triangulate checked points (n, 3); vertices of the result are rows of these.

    Parameters
    ----------
    points : ndarray of float64 (n, 3)
    machine : scanvec.Machine
    exact : bool
        Whether sites are taken as they are; otherwise they are perturbed.
    dtype : numpy.dtype
        The working precision of perturbed sites.
    seed : int
        Of the perturbation.
    report : callable, optional
        Called as ``report(iteration, open_faces, tetrahedra)`` after every iteration.

    Raises
    ------
    DegenerateInputError
        If all sites lie on a plane, a line or a point.
    InconsistencyError
        If the perturbation does not decide enough to finish.
    InternalError
        If exact decisions contradict each other.
    ValueError
        If ``exact``, and differences of coordinates are too small beside the greatest of these.
    """
    if exact:
        used, duplicates = first_copies(points)
        sites = exactly_scaled(points[used])
        _check_volume(sites)
    else:
        sites, used, duplicates = _perturbed(points, dtype, seed)
    outcome = extrapolate(machine, sites, exact, report)
    outcome.simplices = used[outcome.simplices].astype(np.int32)
    outcome.duplicates = duplicates
    if not exact:
        outcome.inconsistencies += _faults(points, used, outcome)
    if outcome.inconsistencies:
        msg = (
            f"the triangulation has {outcome.inconsistencies} inconsistencies: tetrahedra that contradict "
            f"others were left out, so it may have holes or overlaps. Use method='insertion' (exact), "
            f"dtype='float64', or another seed"
        )
        warnings.warn(msg, InconsistencyWarning, stacklevel=CALLER)
    return outcome


def _check_volume(sites: np.ndarray) -> None:
    """Raise DegenerateInputError unless distinct sites (n, 3) span a volume, however thin; exactly."""
    if affine_dimension(normalise(sites), CLEARLY_THICK) < 3:
        from .._first_tetrahedron import first_tetrahedron

        first_tetrahedron(sites, 0)


def _perturbed(points: np.ndarray, dtype: np.dtype, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Distinct sites, normalised and perturbed; their indices among the points; and the duplicates."""
    used, duplicates = first_copies(points)
    used.sort()  # buckets have an order of their own; this one shows in the rows of the result
    distinct = normalise(points[used])
    # sixteen times what rounding the coordinates can do to a plane
    check_volume(distinct, 16 * float(np.finfo(dtype).eps))
    sites = perturb(distinct, dtype, seed)
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


def _faults(points: np.ndarray, used: np.ndarray, outcome: Outcome) -> int:
    """Open hull edges and flat or turned tetrahedra; raises where a site was lost."""
    missing = np.setdiff1d(used, outcome.simplices)
    if len(missing):
        msg = (
            f"{len(missing)} sites are in no tetrahedron, the first is {missing[0]}: the perturbation "
            f"does not decide this set. Use method='insertion', which is exact, or dtype='float64', or "
            f"another seed"
        )
        raise InconsistencyError(msg, len(missing))
    corners = normalise(points)[outcome.simplices]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    hull = _topology.hull_facets(outcome.simplices, outcome.neighbors)
    return _topology.open_edges(hull) + int((volumes <= 0).sum())

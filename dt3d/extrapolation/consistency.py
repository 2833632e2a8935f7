"""What is made of inconsistencies: how many are too many, and those that no dictionary shows.

Teng et al. 1993, section 5.2, and Table 3. The dictionary of dead faces finds tetrahedra that contradict
earlier ones (`dead_faces.py`); sites without a tetrahedron, open edges of the hull and flat tetrahedra are
counted at the end.
"""

from __future__ import annotations

import numpy as np

from .._errors import InconsistencyError, InternalError
from .._topology import hull_facets, open_edges
from .outcome import Outcome
from .perturbation import normalise

# A set is given up when so large a share of the tetrahedra found, and more than so many, contradict others
# ("too many" in the paper's Table 3).
GIVE_UP_SHARE = 0.02
GIVE_UP_COUNT = 100


def check_progress(out: Outcome, n: int, exact: bool) -> None:
    """Raise an error where a run over n sites cannot come to an end, or has contradicted itself.

    Raises
    ------
    InconsistencyError
        If too many tetrahedra contradict others for the set to be finished.
    InternalError
        The same if ``exact``, when a single one is too many.
    """
    total = out.tetrahedra
    if exact and out.inconsistencies:
        msg = f"{out.inconsistencies} of {total} tetrahedra contradict others, which exact decisions exclude"
        raise InternalError(msg)
    # no triangulation of n sites has n^2 / 2 tetrahedra, so a run that goes round in circles ends too
    if exact and 2 * total > n * n:
        msg = f"{total} tetrahedra of {n} sites were found, more than any triangulation has"
        raise InternalError(msg)
    if out.inconsistencies > max(GIVE_UP_COUNT, GIVE_UP_SHARE * total) or 2 * total > n * n:
        msg = (
            f"{out.inconsistencies} inconsistencies among {total} tetrahedra after "
            f"{len(out.per_iteration)} iterations: sites too close to cospherical for this precision and "
            f"perturbation. Use method='insertion', which is exact; or dtype='float64', or another seed"
        )
        raise InconsistencyError(msg, out.inconsistencies)


def count_faults(points: np.ndarray, used: np.ndarray, out: Outcome) -> int:
    """Open hull edges and flat or turned tetrahedra of the used points; raises where a site was lost.

    Raises
    ------
    InconsistencyError
        If a site is in no tetrahedron.
    """
    missing = np.setdiff1d(used, out.simplices)
    if len(missing):
        msg = (
            f"{len(missing)} sites are in no tetrahedron, the first is {missing[0]}: the perturbation "
            f"does not decide this set. Use method='insertion', which is exact, or dtype='float64', or "
            f"another seed"
        )
        raise InconsistencyError(msg, len(missing))
    corners = normalise(points)[out.simplices]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    return open_edges(hull_facets(out.simplices, out.neighbors)) + int((volumes <= 0).sum())

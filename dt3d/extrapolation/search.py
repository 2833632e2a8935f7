"""The search for each query's best site: through the paper's cells where sites are even, else through a tree.

Teng et al. 1993, section 4.2, and beyond it. All queries search at once.
"""

from __future__ import annotations

import scanvec as sv

from . import cell_requests
from .buckets import Buckets
from .points import Point
from .tree import search as tree_search
from .warrants import Q, SearchResult, SearchSpec, nothing_found


def search(
    buckets: Buckets, queries: object, first: tuple[Point[sv.Vector], Point[sv.Vector]], spec: SearchSpec[Q]
) -> SearchResult:
    """The site of least score for each of m queries, a record of vectors of length m.

    ``first`` are the lowest and highest corners of boxes in which the search through cells begins.
    """
    if not len(first[0].x):
        return SearchResult(nothing_found(buckets.machine, 0, buckets.sites.x.dtype), 0)
    if buckets.cells is None:
        return tree_search.search(buckets, queries, spec)
    return cell_requests.search(buckets, queries, first, spec)

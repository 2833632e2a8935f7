"""How sites are put into cells, and how cells are searched: as Teng et al. 1993 do, and beyond."""

from __future__ import annotations

from dataclasses import dataclass

SITES_PER_CELL = 8  # on average: "the number we obtained", section 7
# After so many rounds all cells that are left are opened at once (section 4.2, which does not say how many).
# In the paper's mode as many as meet Table 2's times best: every round of the few faces left costs its steps.
PRESET_LIMIT, PAPER_PRESET_LIMIT = 8, 3


@dataclass(frozen=True, kw_only=True)
class SearchOptions:
    """Constants of sections 4.2 and 5.1; hashable, since compiled steps are kept by them.

    Attributes
    ----------
    whole_boxes : bool
        Whether all cells of a box are opened, as in the paper; otherwise those that cannot hold a better site
        are left out, and boxes are those of spherical caps. Perturbed sites only.
    uniform_cells : bool
        Whether sites are put into the cells of a cube however uneven they are, as in the paper; otherwise
        uneven sites get a tree of boxes.
    sites_per_cell : int
        On average.
    sites_per_warrant : int
        The most that a warrant searches.
    preset_limit : int
        The rounds after which all cells that are left are opened.
    eta : float or None
        Of the perturbation I + eta M; None for the one that suits the precision.
    """

    whole_boxes: bool = False
    uniform_cells: bool = False
    sites_per_cell: int = SITES_PER_CELL
    sites_per_warrant: int = SITES_PER_CELL
    preset_limit: int = PRESET_LIMIT
    eta: float | None = None


DEFAULT_SEARCH = SearchOptions()
PAPER_SEARCH = SearchOptions(whole_boxes=True, uniform_cells=True, preset_limit=PAPER_PRESET_LIMIT)

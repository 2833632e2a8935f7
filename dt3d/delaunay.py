"""`dt3d.Delaunay`: the options choose an engine, whose result becomes read-only arrays."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, Unpack

import numpy as np
import numpy.typing as npt

import scanvec as sv

from ._extrapolation_options import ExtrapolationOptions, chosen_preset, search_options
from ._input import check_points, check_seed, exactly_scaled, word_of
from ._options import Method, Robustness, check_names, check_space_options
from ._results import Names
from ._stats import InsertionStatistics, Progress, Statistics
from ._triangulation import InSpace, Part, Whole
from .extrapolation import Outcome
from .extrapolation import triangulate as extrapolate
from .subset import Subset

if TYPE_CHECKING:
    from ._proof import Verification


class Delaunay(Whole[Subset], InSpace):
    """The Delaunay triangulation of points in space.

    Which call runs what:

    ========================================  ===========================================================
    call                                      engine
    ========================================  ===========================================================
    ``Delaunay(points)``                      insertion by threads on this CPU
    ``Delaunay(points, method=E)``            extrapolation on ``scanvec.Device()``: whole steps compiled,
                                              from 2,000 sites that fill space evenly; else vectors
    ``Delaunay(points, machine=S)``           extrapolation in vectors, exact search; a ledger of its steps
    ``Delaunay(points, machine=S,             the paper: Teng, Sullivan, Beichl and Puppo (1993), with their
    preset="teng1993")``                      boxes, random perturbation and consistency check
    ``Delaunay(points, machine=S,             the same with cells that are pruned, and a tree where sites are
    robustness="perturb")``                   uneven
    ``threaded2d.Delaunay(points2d)``         in the plane: threads that change one mesh in place
    ``threaded2d.Delaunay(points2d,           in the plane: Kohout, Kolingerova and Zara (2004), whose other
    method="batch", preset="kohout2004")``    methods have names, too
    ========================================  ===========================================================

    Here E is "extrapolation" and S is ``scanvec.Simulated(processors=32)``. The exact engines find the same
    tetrahedra.

    The result stays as it was computed: its arrays are read-only, and its attributes cannot be assigned. Take
    a copy of an array to change it, and `subset` for a part of the tetrahedra.

    Parameters
    ----------
    points : array_like (n, 3)
        Sites: real, finite, at least four that do not lie on a plane.
    method : "auto", "insertion" or "extrapolation"
        "insertion" inserts the sites one by one on a CPU. "extrapolation" is the data-parallel algorithm of
        Teng et al. on a scanvec machine. "auto" inserts, unless ``machine`` or ``robustness="perturb"`` is
        given, which only extrapolation has. Extrapolation compares every face with every site where
        thousands of sites lie on one sphere.
    robustness : "exact" or "perturb"
        "exact": all decisions are right. A symbolic perturbation decides cospherical sites, and the result
        does not depend on the method, the machine or the order of the sites. "perturb", by extrapolation
        only: the paper's random linear perturbation of about 1e-9 decides cospherical sites, in floating
        point, and a check of the topology counts inconsistencies.
    machine : scanvec.Machine, optional
        Where extrapolation runs: ``scanvec.Device()`` by default, or ``scanvec.Simulated(processors=P)``. All
        machines give the same tetrahedra.
    threads : int, optional
        The most threads that insert at the same time; never more than the cores that this process may use.
        By default as many as cores, fewer for small sets. The result does not depend on it.
    dtype : float64 or float32, optional
        Working precision, float64 by default. Single precision is for experiments with
        ``robustness="perturb"``: it decides less.
    seed : int
        Not negative, of any size: for the perturbation, or for the order of insertion, which does not change
        the result.
    callback : callable, optional
        Called with a `Progress` after every iteration of an extrapolation, or every 100,000 sites inserted.
        An exception that it raises ends the triangulation.
    preset : "teng1993", optional
        All that is the paper's, by extrapolation: ``robustness="perturb"``, ``search="boxes"`` and
        ``cells="uniform"``. Options below that are given beside it hold.
    search : "caps" or "boxes", optional
        Section 4.2: which cells a face expansion opens. "boxes", with ``robustness="perturb"`` only: all in
        the containment box of the circumsphere, as in the paper. "caps", the default: those that the
        spherical cap above the face meets.
    cells : "auto" or "uniform", optional
        "uniform": the cells of a cube, as in the paper. "auto", the default: a tree of boxes where sites do
        not fill space evenly.
    sites_per_cell, sites_per_warrant : int, optional
        Sites of a cell on average, 8 by default (section 7), and the most that a warrant searches, by default
        as many.
    preset_limit : int, optional
        Rounds of a search after which all cells that are left are opened: 3 with search="boxes", 8 otherwise.
        The paper's preset limit is not published.
    eta : float, optional
        Of the perturbation I + eta M (section 5.1), with ``robustness="perturb"``. By default 2^-30 in double
        and 2^-12 in single precision; the paper's is not published.

    Cells other than the default ones are searched in vectors, on ``scanvec.Device()``, too.

    Attributes
    ----------
    points : ndarray of float64 (n, 3)
        The sites as given.
    simplices : ndarray of int32 (m, 4)
        Tetrahedra, each positively oriented: det[b-a, c-a, d-a] > 0.
    neighbors : ndarray of int32 (m, 4)
        The k-th is the tetrahedron opposite the k-th vertex, `dt3d.OUTSIDE` (-1) beyond the hull.
    iteration : ndarray of int32 (m,)
        The iteration, from 1, that found each tetrahedron: by extrapolation the paper's round, on any
        machine; by insertion 1 for all.
    duplicates : ndarray of int32 (k, 2)
        A site that was not used, and the equal site that was.
    stats : Statistics or InsertionStatistics
        Counts and times; each method has counts of its own.

    Raises
    ------
    ValueError
        For input that is not finite, real and of shape (n, 3), and for options that are out of range or do
        not go together; by extrapolation also
        where coordinates differ by less than 2^-200 of the greatest one.
    TypeError
        For an option that there is not.
    DegenerateInputError
        If all sites lie on a plane, a line or a point.
    InconsistencyError
        If the perturbation does not decide enough for the method to finish.
    MemoryError
        If the system does not have the memory; says what is needed.
    InternalError
        A fault of dt3d, to be reported, in place of a wrong result or an endless loop.

    Warns
    -----
    InconsistencyWarning
        If the result has inconsistencies, or if sites coincide in the working precision only.
    QuadraticSearchWarning
        If extrapolation compares each of many faces with thousands of sites, as on one sphere.

    Examples
    --------
    >>> import numpy as np, dt3d
    >>> cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    >>> tri = dt3d.Delaunay(cube)
    >>> tri.simplices.shape, tri.convex_hull.shape
    ((6, 4), (12, 3))
    """

    stats: Statistics | InsertionStatistics
    """Counts and times."""

    _dimension: ClassVar[int] = 3
    _part: ClassVar[type[Part]] = Subset
    _others: ClassVar[Names] = ("stats", "_exact")

    def __init__(
        self,
        points: npt.ArrayLike,
        *,
        method: Method = "auto",
        robustness: Robustness = "exact",
        machine: sv.Machine | None = None,
        threads: int | None = None,
        seed: int = 0,
        callback: Callable[[Progress], object] | None = None,
        **options: Unpack[ExtrapolationOptions],
    ) -> None:
        begun = time.perf_counter()
        seed = check_seed(seed)
        check_names(options, ExtrapolationOptions.__annotations__, "dt3d.Delaunay")
        if chosen_preset(options) is not None:
            robustness = "perturb"
        dtype = options.get("dtype")
        chosen, working = check_space_options(method, robustness, machine, threads, callback, dtype)
        exact = robustness == "exact"
        search = search_options(options, chosen, exact=exact)
        self._keep(points=check_points(points), _exact=exact)

        def report(iteration: int, left: int, tetrahedra: int) -> None:
            if callback is not None:
                callback(Progress(iteration, left, tetrahedra, time.perf_counter() - begun))

        if chosen == "insertion":
            self._insert(seed, threads, report, begun)
        else:
            outcome = extrapolate(
                self.points,
                sv.Device() if machine is None else machine,
                exact=exact,
                dtype=working,
                seed=seed,
                report=report,
                options=search,
            )
            self._take(outcome, machine, begun)

    def _insert(
        self, seed: int, threads: int | None, report: Callable[[int, int, int], None], begun: float
    ) -> None:
        from ._numba.announce import announce_compilation
        from .insertion import triangulate

        announce_compilation()
        stretches = itertools.count(1)
        outcome = triangulate(
            exactly_scaled(self.points),
            word_of(seed),
            threads,
            lambda left, made: report(next(stretches), left, made),
        )
        self._keep(
            simplices=outcome.simplices,
            neighbors=outcome.neighbors,
            duplicates=outcome.duplicates,
            iteration=np.ones(len(outcome.simplices), np.int32),
            stats=InsertionStatistics(
                walked=outcome.walked,
                tested=outcome.tested,
                created=outcome.created,
                threads=outcome.threads,
                deferred=outcome.deferred,
                inconsistencies=0,
                seconds=outcome.seconds | {"total": time.perf_counter() - begun},
            ),
        )

    def _take(self, outcome: Outcome, machine: sv.Machine | None, begun: float) -> None:
        ledger = None if machine is None else machine.ledger
        self._keep(
            simplices=outcome.simplices,
            neighbors=outcome.neighbors,
            iteration=outcome.iteration,
            duplicates=outcome.duplicates,
            stats=outcome.statistics(ledger, time.perf_counter() - begun),
        )

    @staticmethod
    def _proof() -> Callable[..., Verification]:
        from .verification import verify

        return verify

    def __repr__(self) -> str:
        """How many sites and tetrahedra."""
        return f"<dt3d.Delaunay: {len(self.points)} sites, {len(self.simplices)} tetrahedra>"

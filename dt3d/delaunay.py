"""`dt3d.Delaunay`: the options choose an engine, whose result becomes read-only arrays."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, Unpack

import numpy as np
import numpy.typing as npt

from ._errors import DegenerateInputError
from ._extrapolation_options import search_options
from ._given import PointsLike
from ._input import advised, check_points, check_seed, exactly_scaled, word_of
from ._living import Living
from ._options import Method, SpaceOptions, check_names, check_of_plane, check_space_options
from ._results import Names
from ._scipy_members import SciPyMembers
from ._scipy_options import check_scipy_options
from ._stats import InsertionStatistics, Progress, Statistics

if TYPE_CHECKING:
    import scanvec as sv

    from ._proof import Verification
    from .alpha import AlphaComplex
    from .extrapolation import Outcome
    from .subset import Subset
    from .threaded2d.driver import Outcome as PlaneOutcome
    from .threaded2d.statistics import Statistics as PlaneStatistics


class Delaunay(SciPyMembers):
    """The Delaunay triangulation of points in the plane or in space, exact.

    It has all members of `scipy.spatial.Delaunay`, with the same names, shapes, dtypes and meaning, and takes
    its place.

    Which call runs what:

    =============================================  ===========================================================
    call                                           engine
    =============================================  ===========================================================
    ``Delaunay(points)``                           insertion by threads on this CPU, in the plane and in space
    ``Delaunay(points, method=E)``                 in space: extrapolation on ``scanvec.Device()``, whole
                                                   steps compiled, from 2,000 sites that fill space evenly;
                                                   else vectors
    ``Delaunay(points, machine=S)``                in space: extrapolation in vectors, exact search; a ledger
                                                   of its steps
    ``Delaunay(points, machine=S, preset=T)``      in space: the paper of Teng, Sullivan, Beichl and Puppo
                                                   (1993), their boxes, random perturbation and check
    ``Delaunay(points, machine=S, robustness=P)``  in space: the same with cells that are pruned, and a tree
                                                   where sites are uneven
    ``threaded2d.Delaunay(points2d, preset=K)``    in the plane: Kohout, Kolingerova and Zara (2004), whose
                                                   methods have names, too
    =============================================  ===========================================================

    Here E is "extrapolation", T "teng1993", P "perturb", K "kohout2004", and S is
    ``scanvec.Simulated(processors=32)``. The exact engines find the same simplices.

    The result stays as it was computed: its arrays are read-only, and its attributes cannot be assigned. Take
    a copy of an array to change it, and `subset` for a part of the simplices. Below, d is 2 or 3.

    Parameters
    ----------
    points : array_like (n, 2) or (n, 3)
        Sites: real, finite, at least d + 1 that do not lie on a plane, in the plane on a line. Also a
        table of pandas, a dataset of PyVista.
    furthest_site : bool
        As in SciPy's class, False only.
    incremental : bool
        As in SciPy's class: whether `add_points` may add sites later. By insertion only.
    qhull_options : str, optional
        As in SciPy's class. Options that say how Qhull rounds, scales and merges change nothing here; those
        that ask for another result raise a ValueError.
    method : "auto", "insertion" or "extrapolation"
        "insertion" inserts the sites one by one on a CPU. "extrapolation", in space, is the data-parallel
        algorithm of Teng et al. on a scanvec machine. "auto" inserts, unless ``machine`` or
        ``robustness="perturb"`` is given, which only extrapolation has. Extrapolation compares every face
        with every site where thousands of sites lie on one sphere.
    threads : int, optional
        The most threads that insert at the same time; never more than the cores that this process may use.
        By default as many as cores, fewer for small sets. The result does not depend on it.
    seed : int
        Not negative, of any size: for the perturbation, or for the order of insertion, which does not change
        the result.
    robustness : "exact" or "perturb"
        In space. "exact": all decisions are right. A symbolic perturbation decides cospherical sites, and the
        result does not depend on the method, the machine or the order of the sites. "perturb", by
        extrapolation only: the paper's random linear perturbation of about 1e-9 decides cospherical sites, in
        floating point, and a check of the topology counts inconsistencies.
    machine : scanvec.Machine, optional
        In space: where extrapolation runs, ``scanvec.Device()`` by default, or
        ``scanvec.Simulated(processors=P)``. All machines give the same tetrahedra.
    dtype : float64 or float32, optional
        Working precision, float64 by default. Single precision is for experiments with
        ``robustness="perturb"``: it decides less.
    callback : callable, optional
        In space: called with a `Progress` after every iteration of an extrapolation, or every 100,000 sites
        inserted. An exception that it raises ends the triangulation.
    preset : "teng1993", optional
        In space: all that is the paper's, by extrapolation: ``robustness="perturb"``, ``search="boxes"`` and
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
    points : ndarray of float64 (n, d)
        The sites as given.
    simplices : ndarray of int32 (m, d + 1)
        Positively oriented: tetrahedra with det[b-a, c-a, d-a] > 0, or triangles, counter-clockwise.
    neighbors : ndarray of int32 (m, d + 1)
        The k-th is the simplex opposite the k-th vertex, `dt3d.OUTSIDE` (-1) beyond the hull.
    duplicates : ndarray of int32 (k, 2)
        A site that was not used, and the equal site that was.
    iteration : ndarray of int32 (m,)
        In space: the iteration, from 1, that found each tetrahedron. By extrapolation the paper's round, on
        any machine; by insertion 1 for all.
    thread, inserted_by : ndarray of int16 (m,) and (n,)
        In the plane: the thread that made each triangle, and that inserted each site (-1 for duplicates).
    stats : Statistics, InsertionStatistics or threaded2d.Statistics
        Counts and times; each engine has counts of its own.

    Raises
    ------
    ValueError
        For input that is not finite, real and of shape (n, 2) or (n, 3), and for options that are out of
        range or do not go together; by extrapolation also where coordinates differ by less than 2^-200 of the
        greatest one.
    TypeError
        For an option that there is not.
    DegenerateInputError
        If all sites lie on a plane (in space), a line or a point.
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
    >>> square = dt3d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]])
    >>> square.simplices.shape, square.convex_hull.shape
    ((2, 3), (4, 2))
    """

    stats: Statistics | InsertionStatistics | PlaneStatistics
    """Counts and times."""

    _others: ClassVar[Names] = ("stats", "_exact")
    _name: ClassVar[str] = "dt3d.Delaunay"

    def __init__(
        self,
        points: PointsLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        method: Method = "auto",
        threads: int | None = None,
        seed: int = 0,
        **options: Unpack[SpaceOptions],
    ) -> None:
        begun = time.perf_counter()
        grows = check_scipy_options(furthest_site, incremental, qhull_options, "Delaunay", grows=True)
        seed = check_seed(seed)
        check_names(options, SpaceOptions.__annotations__, "dt3d.Delaunay")
        chosen, working, exact = check_space_options(method, threads, options)
        sites = check_points(points)
        if grows:
            self._begin_to_grow(sites, points, chosen, seed, threads, options)
            return
        if sites.shape[1] == 2:
            check_of_plane(method, options)
            self._insert_in_plane(sites, seed, threads, begun)
            return
        self._keep(points=sites, _exact=exact)
        callback = options.get("callback")

        def report(iteration: int, left: int, tetrahedra: int) -> None:
            if callback is not None:
                callback(Progress(iteration, left, tetrahedra, time.perf_counter() - begun))

        try:
            if chosen == "insertion":
                self._insert(seed, threads, report, begun)
                return
            import scanvec as sv  # and with it JAX

            from .extrapolation import triangulate

            machine = options.get("machine")
            outcome = triangulate(
                self.points,
                sv.Device() if machine is None else machine,
                exact=exact,
                dtype=working,
                seed=seed,
                report=report,
                options=search_options(options, exact=exact),
            )
            self._take(outcome, machine, begun)
        except DegenerateInputError as error:
            raise advised(error, points) from None

    def _begin_to_grow(
        self,
        sites: np.ndarray,
        points: PointsLike,
        chosen: str,
        seed: int,
        threads: int | None,
        options: SpaceOptions,
    ) -> None:
        if chosen != "insertion" or options.get("callback") is not None:
            msg = (
                "incremental=True goes with insertion, without a callback: leave out method, machine, "
                "robustness and callback"
            )
            raise ValueError(msg)
        if sites.shape[1] == 2:
            check_of_plane("auto", options)
        self._keep(_exact=True)
        self.__dict__["_living"] = Living(sites, word_of(seed), threads)
        try:
            self._catch_up()
        except DegenerateInputError as error:
            raise advised(error, points) from None

    def _catch_up(self) -> None:
        living: Living = self.__dict__["_living"]
        if living.dimension == 2:
            self._insert_in_plane(living.points, living.seed, living.threads, time.perf_counter())
        else:
            self._keep(**living.in_space())

    def _insert(
        self, seed: int, threads: int | None, report: Callable[[int, int, int], None], begun: float
    ) -> None:
        from .insertion import triangulate

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

    def _insert_in_plane(self, sites: np.ndarray, seed: int, threads: int | None, begun: float) -> None:
        from ._numba.cores import available_cores
        from .threaded2d.configuration import configured
        from .threaded2d.driver import triangulate

        most = None if threads is None else min(threads, available_cores())
        run = configured(len(sites), threads=most, seed=word_of(seed))
        prepared = time.perf_counter()
        self._take_triangles(sites, triangulate(exactly_scaled(sites), run), begun, prepared)

    def _take_triangles(
        self, sites: np.ndarray, outcome: PlaneOutcome, begun: float, prepared: float
    ) -> None:
        outcome.stats.seconds["input"] = prepared - begun
        outcome.stats.seconds["total"] = time.perf_counter() - begun
        self._keep(
            points=sites,
            simplices=outcome.triangles,
            neighbors=outcome.neighbors,
            thread=outcome.thread,
            inserted_by=outcome.inserted_by,
            duplicates=outcome.duplicates,
            stats=outcome.stats,
            _exact=True,
        )

    def subset(self, keep: npt.ArrayLike) -> Subset:
        """Some of the simplices, as an object of its own with `find_simplex`: holes, alpha shapes.

        Parameters
        ----------
        keep : bool (m,), or int (k,)
            A mask of the simplices, or rows of `simplices` without repetition.

        Raises
        ------
        ValueError
            If it is neither.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.subset([0])
        <1 of 2 simplices of <dt3d.Delaunay: 4 sites, 2 triangles>>
        """
        from .subset import Subset

        return Subset(self, keep)

    def boundary(self, keep: npt.ArrayLike) -> np.ndarray:
        """The facets between the simplices that a mask keeps and all else: int32 (b, d), oriented outwards.

        Those of ``subset(keep).boundary``, and for a mask of all those of `convex_hull`.

        Parameters
        ----------
        keep : bool (m,), or int (k,)
            A mask of the simplices, or rows of `simplices` without repetition.

        Raises
        ------
        ValueError
            If it is neither.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.boundary([0]).shape, tri.boundary(tri.volumes > 0).shape
        ((3, 2), (4, 2))
        """
        return self.subset(keep).boundary

    def alpha_shape(self, alpha: float) -> Subset:
        """The simplices of which the circumscribed sphere has a radius of at most alpha.

        This is the solid part of the alpha shape of H. Edelsbrunner and E. P. Muecke (Three-dimensional alpha
        shapes, ACM Transactions on Graphics 13, 1994): triangles in the plane, tetrahedra in space. Edges and
        triangles that no such simplex has are not in it; `alpha_complex` has these.

        Parameters
        ----------
        alpha : float
            A radius, in units of the coordinates, as PyVista's ``delaunay_3d(alpha=)`` takes it. CGAL and
            GUDHI take its square. From ``circumradii.max()`` on the shape is the convex hull.

        Returns
        -------
        Subset
            With `Subset.boundary`, the surface, and `Subset.find_simplex`. It may have holes and parts.

        Raises
        ------
        ValueError
            If alpha is not a number from 0 on.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [9, 9]])
        >>> tri.alpha_shape(2).boundary.shape
        (3, 2)
        """
        number = isinstance(alpha, int | float | np.number) and not isinstance(alpha, bool)
        if not (number and alpha >= 0):
            msg = f"alpha must be a radius, a number that is not negative, got {alpha!r}"
            raise ValueError(msg)
        return self.subset(self.circumradii <= alpha)

    def alpha_complex(self) -> AlphaComplex:
        """The simplices of every dimension with the squared radii at which they appear.

        As GUDHI's ``AlphaComplex(points).create_simplex_tree()``, in arrays.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2]]).alpha_complex()
        <dt3d.AlphaComplex: 3, 3, 1 simplices>
        """
        from .alpha import AlphaComplex

        return AlphaComplex(self)

    def verify(self) -> Verification:
        """Check every invariant in exact arithmetic; print the outcome for the list.

        The outcome is false if one is broken. Unless ``robustness="perturb"`` was asked for, the result must
        also be the one triangulation that the symbolic perturbation defines.

        Examples
        --------
        >>> import dt3d
        >>> bool(dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).verify())
        True
        """
        return self._proof()(
            self.points,
            self.simplices,
            neighbors=self.neighbors,
            duplicates=self.duplicates,
            perturbed=self._exact,
            oriented=True,
        )

    def _proof(self) -> Callable[..., Verification]:
        """The function `verify` of this dimension; it loads numba."""
        if self.ndim == 2:
            from .threaded2d.verification import verify as of_plane

            return of_plane
        from .verification import verify

        return verify

    def __repr__(self) -> str:
        """How many sites and simplices."""
        kind = "triangles" if self.ndim == 2 else "tetrahedra"
        return f"<{self._name}: {len(self.points)} sites, {len(self.simplices)} {kind}>"

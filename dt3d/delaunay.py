"""The public class: `dt3d.Delaunay`."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import scanvec as sv

from . import _topology
from ._input import check_points, check_seed, exactly_scaled, word_of
from ._results import Names, Result, check_array, check_complex, check_range, frozen
from ._stats import InsertionStatistics, Progress, Statistics
from .extrapolation import triangulate as extrapolate
from .subset import Subset

if TYPE_CHECKING:
    import pyvista

    from .location import Locator
    from .verification import Verification

METHODS = ("auto", "insertion", "extrapolation")
ROBUSTNESS = ("exact", "perturb")


class Delaunay(Result):
    """The Delaunay triangulation of points in space.

    The result stays as it was computed: its arrays are read-only, and its attributes cannot be assigned. Take
    a copy of an array to change it, and `subset` for a part of the tetrahedra.

    Parameters
    ----------
    points : array_like (n, 3)
        Sites: real, finite, at least four that do not lie on a plane.
    method : "auto", "insertion" or "extrapolation"
        "insertion" puts the sites in one by one on a CPU, exactly. "extrapolation" is the data-parallel
        method of Teng, Sullivan, Beichl and Puppo (1993) on a scanvec machine. "auto" inserts, unless
        ``machine`` or ``robustness="perturb"`` asks for what only extrapolation has. Both find the same
        tetrahedra; but extrapolation compares every face with every site where thousands lie on one sphere.
    robustness : "exact" or "perturb"
        "exact": all decisions are right, cospherical sites are decided by a symbolic perturbation, and the
        result does not depend on the method, the machine or the order of the sites. "perturb": the paper's
        random linear perturbation of about 1e-9 decides cospherical sites, in floating point, and a check of
        the topology counts inconsistencies; by extrapolation only.
    machine : scanvec.Machine, optional
        Where extrapolation runs: ``scanvec.Device()`` by default, or ``scanvec.Simulated(processors=P)``. All
        machines give the same tetrahedra.
    threads : int, optional
        At most so many threads insert at the same time, and no more than this process has cores. By default
        as many as cores, or fewer where more do not pay. The result does not depend on it.
    dtype : float64 or float32, optional
        Working precision, float64 by default. Single precision is for experiments with
        ``robustness="perturb"``: it decides less.
    seed : int
        Of any size, not negative: of the perturbation, or of the order of insertion (which does not change
        the result).
    callback : callable, optional
        Called with a `Progress` after every iteration, or stretch of 100,000 sites inserted. What it raises
        ends the triangulation.

    Attributes
    ----------
    points : ndarray of float64 (n, 3)
        The sites as given.
    simplices : ndarray of int32 (m, 4)
        Tetrahedra, each positively oriented: det[b-a, c-a, d-a] > 0.
    neighbors : ndarray of int32 (m, 4)
        The k-th is the tetrahedron opposite the k-th vertex, `dt3d.OUTSIDE` (-1) beyond the hull.
    iteration : ndarray of int32 (m,)
        The iteration, from 1, that found each tetrahedron; 1 for all by insertion.
    duplicates : ndarray of int32 (k, 2)
        A site that was not used, and the equal site that was.
    stats : Statistics or InsertionStatistics
        Counts and times, of what the method counts.

    Raises
    ------
    ValueError
        For input that is not finite, real and of shape (n, 3), and for unknown options; by extrapolation also
        where coordinates differ by less than 2^-200 of the greatest one.
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

    points: np.ndarray
    """The sites as given, float64 (n, 3)."""
    simplices: np.ndarray
    """Tetrahedra, positively oriented, int32 (m, 4)."""
    neighbors: np.ndarray
    """The tetrahedron opposite each vertex, `dt3d.OUTSIDE` (-1) beyond the hull, int32 (m, 4)."""
    iteration: np.ndarray
    """The iteration, from 1, that found each tetrahedron, int32 (m,)."""
    duplicates: np.ndarray
    """A site that was not used, and the equal site that was, int32 (k, 2)."""
    stats: Statistics | InsertionStatistics
    """Counts and times."""
    _exact: bool

    _arrays: ClassVar[Names] = ("points", "simplices", "neighbors", "iteration", "duplicates")
    _others: ClassVar[Names] = ("stats", "_exact")
    _derived: ClassVar[Names] = ("convex_hull", "vertex_neighbor_vertices", "_locator")

    def __init__(
        self,
        points: Any,
        *,
        method: str = "auto",
        robustness: str = "exact",
        machine: sv.Machine | None = None,
        threads: int | None = None,
        dtype: Any = None,
        seed: int = 0,
        callback: Callable[[Progress], Any] | None = None,
    ) -> None:
        begun = time.perf_counter()
        working = _check_dtype(dtype)
        seed = check_seed(seed)
        if callback is not None and not callable(callback):
            msg = f"callback must be callable, got {callback!r}"
            raise ValueError(msg)
        method = _check_method(method, robustness, machine, working)
        _check_threads(threads, method)
        self._keep(points=check_points(points), _exact=robustness == "exact")

        def report(iteration: int, left: int, tetrahedra: int) -> None:
            if callback is not None:
                callback(Progress(iteration, left, tetrahedra, time.perf_counter() - begun))

        if method == "insertion":
            self._insert(seed, threads, report, begun)
        else:
            machine = sv.Device() if machine is None else machine
            self._extrapolate(machine, robustness == "exact", working, seed, report, begun)

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

    def _extrapolate(
        self,
        machine: sv.Machine,
        exact: bool,
        working: np.dtype,
        seed: int,
        report: Callable[[int, int, int], None],
        begun: float,
    ) -> None:
        outcome = extrapolate(self.points, machine, exact=exact, dtype=working, seed=seed, report=report)
        self._keep(
            simplices=outcome.simplices,
            neighbors=outcome.neighbors,
            iteration=outcome.iteration,
            duplicates=outcome.duplicates,
            stats=outcome.statistics(machine.ledger, time.perf_counter() - begun),
        )

    @cached_property
    def convex_hull(self) -> np.ndarray:
        """Facets of the convex hull, int32 (h, 3), oriented outwards (counter-clockwise from outside)."""
        return frozen(_topology.hull_facets(self.simplices, self.neighbors))

    def find_simplex(self, xi: Any) -> np.ndarray:
        """The tetrahedron that contains each point, exactly; as `scipy.spatial.Delaunay.find_simplex`.

        Parameters
        ----------
        xi : array_like, real (..., 3)

        Returns
        -------
        int32 (...)
            Rows of `simplices`; `dt3d.OUTSIDE` (-1) for points outside the convex hull. Of several tetrahedra
            that have a point on their common border, any one.

        Raises
        ------
        ValueError
            If the points are not finite, real and of shape (..., 3).
        """
        return self._locator.find(xi)

    def subset(self, keep: Any) -> Subset:
        """Some of the tetrahedra, as an object of its own, with `find_simplex`: holes, alpha shapes.

        Parameters
        ----------
        keep : bool (m,), or int (k,)
            A mask of the tetrahedra, or rows of `simplices` without repetition.

        Raises
        ------
        ValueError
            If it is neither.
        """
        return Subset(self, keep)

    @cached_property
    def _locator(self) -> Locator:
        from .location import Locator

        return Locator(self.points, self.simplices, self.neighbors, self._exact)

    @cached_property
    def vertex_neighbor_vertices(self) -> tuple[np.ndarray, np.ndarray]:
        """The vertices that an edge joins with each site: ``(indptr, indices)``, int32 (n + 1,) and (2 e,).

        Those of site k are ``indices[indptr[k]:indptr[k + 1]]``, in ascending order; none for duplicates.
        """
        from ._vertices import neighbors_of_vertices

        # it indexes without a check
        check_range("simplices", self.simplices, 0, len(self.points))
        indptr, indices = neighbors_of_vertices(self.simplices, len(self.points))
        return frozen(indptr), frozen(indices)

    def verify(self) -> Verification:
        """Prove the result with exact arithmetic; false, and a sentence for each invariant, where it fails.

        Unless ``robustness="perturb"`` was asked for, it must also be the one triangulation that the symbolic
        perturbation defines.
        """
        from .verification import verify

        return verify(
            self.points,
            self.simplices,
            neighbors=self.neighbors,
            duplicates=self.duplicates,
            perturbed=self._exact,
            oriented=True,
        )

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The tetrahedra as a PyVista grid with cell data "iteration" and "volume".

        Raises ImportError, saying what to install, where PyVista is missing.
        """
        from ._mesh import to_pyvista

        return to_pyvista(self)

    def _check(self, own: dict[str, Any]) -> None:
        n, m = len(own["points"]), len(own["simplices"])
        check_complex(own["points"], own["simplices"], own["neighbors"], dimension=3)
        check_array("iteration", own["iteration"], np.int32, (m,))
        check_array("duplicates", own["duplicates"], np.int32, (len(own["duplicates"]), 2))
        check_range("duplicates", own["duplicates"], 0, n)

    def __repr__(self) -> str:
        return f"<dt3d.Delaunay: {len(self.points)} sites, {len(self.simplices)} tetrahedra>"


def _check_method(method: Any, robustness: Any, machine: Any, dtype: np.dtype) -> str:
    """The method that the options ask for."""
    if method not in METHODS:
        msg = f"method must be {', '.join(map(repr, METHODS[:-1]))} or {METHODS[-1]!r}, got {method!r}"
        raise ValueError(msg)
    if robustness not in ROBUSTNESS:
        msg = f"robustness must be 'exact' or 'perturb', got {robustness!r}"
        raise ValueError(msg)
    if machine is not None and not isinstance(machine, sv.Machine):
        msg = f"machine must be a scanvec machine, such as scanvec.Simulated(processors=32), got {machine!r}"
        raise ValueError(msg)
    if dtype == np.float32 and robustness == "exact":
        msg = "dtype='float32' cannot hold the sites exactly; it goes with robustness='perturb'"
        raise ValueError(msg)
    only_extrapolation = machine is not None or robustness == "perturb"
    if method == "insertion" and only_extrapolation:
        msg = (
            "method='insertion' is exact, and runs on this CPU; machine and robustness='perturb' go with "
            "method='extrapolation'"
        )
        raise ValueError(msg)
    if method == "auto":
        return "extrapolation" if only_extrapolation else "insertion"
    return method


def _check_threads(threads: Any, method: str) -> None:
    if threads is None:
        return
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        msg = f"threads must be a positive integer, or None for as many as there are cores, got {threads!r}"
        raise ValueError(msg)
    if method != "insertion":
        msg = f"threads={threads} goes with method='insertion'; what extrapolation runs on is its machine"
        raise ValueError(msg)


def _check_dtype(dtype: Any) -> np.dtype:
    try:
        working = np.dtype(np.float64 if dtype is None else dtype)
    except TypeError:
        working = None
    if working not in (np.float32, np.float64):
        msg = f"dtype must be float64 or float32, got {dtype!r}"
        raise ValueError(msg)
    return working

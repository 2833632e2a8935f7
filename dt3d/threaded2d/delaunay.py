"""The public class of the 2D methods."""

from __future__ import annotations

import time
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from .._input import check_points, check_seed, exactly_scaled, word_of
from .._numba.announce import announce_compilation
from .._results import Names, Result, check_array, check_complex, check_range
from .configuration import LOCATIONS, METHODS, MOST_THREADS, ORDERS, configured
from .driver import triangulate
from .input_subdivision import SUBDIVISIONS
from .statistics import Statistics
from .subset import Subset, border

if TYPE_CHECKING:
    import pyvista

    from ..location import Locator
    from .verification import Verification


class Delaunay(Result):
    """The Delaunay triangulation of points in the plane, by threads that insert sites into one structure.

    J. Kohout, I. Kolingerova, J. Zara: Practically oriented parallel Delaunay triangulation in E2 for
    computers with shared memory. Computers & Graphics 28, 2004. The result is exact, and the symbolic
    perturbation makes it unique: every method, number of threads, order and interleaving gives the same
    triangles. It stays as it was computed: arrays are read-only and attributes cannot be assigned. Take a
    copy of an array to change it, and `subset` for a part of the triangles.

    Parameters
    ----------
    points2d : array_like, real (n, 2)
        The sites. Equal ones are used once, see `duplicates`.
    method : str
        "auto": the fastest combination on this machine, "optimistic" with location="walk" and order="brio",
        whatever these say. "sequential"; "batch": threads that locate and one that changes; "circumcircle":
        all do all, and geometry tells who has to wait; "pessimistic": changes in a critical section;
        "optimistic": exclusive access triangle by triangle.
    threads : int, optional
        All threads. By default one for "sequential", for "batch" one more than the searching threads that
        suit n, and otherwise as many as there are processors.
    order : "brio" or "random"
        Of insertion: random rounds along a space-filling curve, or random as in the paper.
    location : "dag" or "walk"
        In the history of the triangulation, as in the paper, or by walking from the triangle found last.
    queue_length : int, optional
        Of the batch method; by default it suits n (Table 1 of the paper).
    subdivision : "random", "x-slabs", "distance" or "curve"
        Which thread gets which sites: at random, slabs of the first coordinate, rings about the origin, or
        stretches of the space-filling curve (with order="brio"). A thread that is done takes of what others
        have left.
    seed : int
        Not negative, of any size: of the random order and subdivision.

    Attributes
    ----------
    points : float64 (n, 2)
    triangles : int32 (m, 3)
        Counter-clockwise.
    neighbors : int32 (m, 3)
        The k-th is opposite the k-th vertex; `dt3d.OUTSIDE` (-1) beyond the hull.
    thread : int16 (m,)
        The thread that made each triangle.
    inserted_by : int16 (n,)
        The thread that inserted each site; -1 for duplicates.
    duplicates : int32 (k, 2)
        A site that was not used, and the equal site that was.
    stats : Statistics

    Raises
    ------
    ValueError
        If the points or an option are not what they should be; the message says what came.
    DegenerateInputError
        If the sites coincide or lie on a line.
    MemoryError
        If the system does not have the memory; says what is needed.
    InternalError
        A fault of dt3d, to be reported, in place of a wrong result or an endless loop.

    Examples
    --------
    >>> import numpy as np
    >>> from dt3d import threaded2d
    >>> tri = threaded2d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1], [0, 0]], threads=2)
    >>> tri.triangles.shape, tri.duplicates.tolist(), bool(tri.verify())
    ((2, 3), [[4, 0]], True)
    """

    points: np.ndarray
    """The sites as given, float64 (n, 2)."""
    triangles: np.ndarray
    """Counter-clockwise, int32 (m, 3)."""
    neighbors: np.ndarray
    """The triangle opposite each vertex, `dt3d.OUTSIDE` (-1) beyond the hull, int32 (m, 3)."""
    thread: np.ndarray
    """The thread that made each triangle, int16 (m,)."""
    inserted_by: np.ndarray
    """The thread that inserted each site, -1 for duplicates, int16 (n,)."""
    duplicates: np.ndarray
    """A site that was not used, and the equal site that was, int32 (k, 2)."""
    stats: Statistics
    """Counts and times."""

    _arrays: ClassVar[Names] = ("points", "triangles", "neighbors", "thread", "inserted_by", "duplicates")
    _others: ClassVar[Names] = ("stats",)
    _derived: ClassVar[Names] = ("simplices", "convex_hull", "_locator")

    def __init__(
        self,
        points2d: Any,
        *,
        method: Literal["auto", "sequential", "batch", "circumcircle", "pessimistic", "optimistic"] = "auto",
        threads: int | None = None,
        order: Literal["brio", "random"] = "brio",
        location: Literal["dag", "walk"] = "dag",
        queue_length: int | None = None,
        subdivision: Literal["random", "x-slabs", "distance", "curve"] = "random",
        seed: int = 0,
    ) -> None:
        begun = time.perf_counter()
        for name, value, choices in (
            ("method", method, METHODS),
            ("order", order, ORDERS),
            ("location", location, LOCATIONS),
            ("subdivision", subdivision, SUBDIVISIONS),
        ):
            if value not in choices:
                msg = f"{name} must be one of {', '.join(map(repr, choices))}, got {value!r}"
                raise ValueError(msg)
        _check_count("threads", threads, 1)
        _check_count("queue_length", queue_length, 2)
        seed = word_of(check_seed(seed))
        if threads is not None and threads > MOST_THREADS:
            msg = f"threads must be at most {MOST_THREADS}, got {threads}"
            raise ValueError(msg)
        if method == "sequential" and threads not in (None, 1):
            msg = f"method='sequential' has one thread, got threads={threads}; choose another method"
            raise ValueError(msg)
        if method == "batch" and threads == 1:
            msg = "method='batch' needs a searching and a specialised thread, got threads=1"
            raise ValueError(msg)
        if subdivision == "curve" and order == "random":
            msg = "subdivision='curve' goes with order='brio', got order='random'"
            raise ValueError(msg)

        announce_compilation()
        points = check_points(points2d, 2)
        sites = exactly_scaled(points)
        options = configured(
            len(sites),
            method=method,
            threads=threads,
            order=order,
            location=location,
            queue_length=queue_length,
            subdivision=subdivision,
            seed=seed,
        )
        prepared = time.perf_counter()
        outcome = triangulate(sites, options)
        self._keep(
            points=points,
            triangles=outcome.triangles,
            neighbors=outcome.neighbors,
            thread=outcome.thread,
            inserted_by=outcome.inserted_by,
            duplicates=outcome.duplicates,
            stats=outcome.stats,
        )
        self.stats.seconds["input"] = prepared - begun
        self.stats.seconds["total"] = time.perf_counter() - begun

    @property
    def simplices(self) -> np.ndarray:
        """The same as `triangles`, under the name that SciPy has and that holds in space, too."""
        return self.triangles

    @cached_property
    def convex_hull(self) -> np.ndarray:
        """Edges of the convex hull, int32 (h, 2), counter-clockwise about the triangles."""
        return border(self.triangles, self.neighbors)

    def find_simplex(self, xi: Any) -> np.ndarray:
        """The triangle that contains each point, exactly; as `scipy.spatial.Delaunay.find_simplex`.

        Parameters
        ----------
        xi : array_like, real (..., 2)

        Returns
        -------
        int32 (...)
            Rows of `triangles`; `dt3d.OUTSIDE` (-1) for points outside the convex hull. Of several triangles
            that have a point on their common border, any one.

        Raises
        ------
        ValueError
            If the points are not finite, real and of shape (..., 2).
        """
        return self._locator.find(xi)

    def subset(self, keep: Any) -> Subset:
        """Some of the triangles, as an object of its own, with `find_simplex`, for example with holes.

        Parameters
        ----------
        keep : bool (m,), or int (k,)
            A mask of the triangles, or rows of `triangles` without repetition.

        Raises
        ------
        ValueError
            If it is neither.
        """
        return Subset(self, keep)

    @cached_property
    def _locator(self) -> Locator:
        from ..location import Locator

        return Locator(self.points, self.triangles, self.neighbors)

    def verify(self) -> Verification:
        """Prove the result with exact arithmetic; false, and a sentence for each invariant, where it
        fails."""
        from .verification import verify

        return verify(
            self.points,
            self.triangles,
            neighbors=self.neighbors,
            duplicates=self.duplicates,
            perturbed=True,
            oriented=True,
        )

    def to_pyvista(self) -> pyvista.PolyData:
        """The triangles as a PyVista surface with cell data "thread".

        Raises ImportError, saying what to install, where PyVista is missing.
        """
        from .picture import to_pyvista

        return to_pyvista(self)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the triangles, coloured by the threads that made them; see `picture.plot`."""
        from .picture import plot

        return plot(self, ax, **options)

    def _check(self, own: dict[str, Any]) -> None:
        n, m = len(own["points"]), len(own["triangles"])
        check_complex(own["points"], own["triangles"], own["neighbors"], dimension=2)
        check_array("thread", own["thread"], np.int16, (m,))
        check_array("inserted_by", own["inserted_by"], np.int16, (n,))
        check_array("duplicates", own["duplicates"], np.int32, (len(own["duplicates"]), 2))
        check_range("duplicates", own["duplicates"], 0, n)

    def __repr__(self) -> str:
        return f"<dt3d.threaded2d.Delaunay: {len(self.points)} sites, {len(self.triangles)} triangles>"


def _check_count(name: str, value: Any, least: int) -> None:
    if value is None:
        return
    if not isinstance(value, int | np.integer) or isinstance(value, bool) or value < least:
        msg = f"{name} must be an integer of at least {least}, got {value!r}"
        raise ValueError(msg)

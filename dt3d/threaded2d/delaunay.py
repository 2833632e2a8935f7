"""`dt3d.threaded2d.Delaunay`: the options choose a method, whose result becomes read-only arrays."""

from __future__ import annotations

import time
from typing import ClassVar, Unpack

from .._given import PointsLike
from .._input import check_points, exactly_scaled
from .._options import Location, Order, PlaneMethod, Subdivision, check_names, check_plane_options
from ..delaunay import Delaunay as Triangulated
from .configuration import configured
from .driver import triangulate
from .options import PlaneOptions, check_values
from .statistics import Statistics


class Delaunay(Triangulated):
    """The `dt3d.Delaunay` of points in the plane, with a choice of threads that insert into one structure.

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
        whatever these two say; one thread for small sets. "sequential": one thread. "batch": several threads
        locate sites, and a specialised one inserts them. "circumcircle": every thread does both, and one
        waits where the circles of its triangles meet those of another. "pessimistic": insertions in a
        critical section. "optimistic": a lock on each triangle.
    threads : int, optional
        All threads. By default one for "sequential", for "batch" one more than the searching threads that
        suit n, otherwise as many as there are processors.
    order : "brio" or "random", optional
        Of insertion: random rounds along a space-filling curve, the default; or random as in the paper, the
        default with the preset.
    location : "dag" or "walk"
        In the history of the triangulation, as in the paper, or by walking from the triangle found last.
    subdivision : "random", "x-slabs", "distance" or "curve"
        Which thread gets which sites: at random, slabs of the first coordinate, rings about the origin, or
        stretches of the space-filling curve (with order="brio"). A thread that has inserted all of its sites
        takes some of another's.
    seed : int
        Not negative, of any size: for the random order and subdivision.
    preset : "kohout2004", optional
        The methods as published: order="random", interleave=1, parts="fixed", queued="parent", tested="all",
        head_start=False. What is given beside it counts. "auto" is then "batch" on up to four processors, and
        "circumcircle" on more.
    interleave : int, optional
        Sites that a thread locates at a time, going on with each search in turn while memory answers the
        others, 1 to 64: by default 8 with "batch" and "circumcircle", 1 with "sequential".
    parts : "shared" or "fixed", optional
        Whether a thread that has inserted all of its sites takes some of another's, the default, or ends
        (section 4.5).
    queued : "leaf" or "parent", optional
        What a searching thread sends of a location: the leaf, the default, or its parent (Algorithm 2).
    queue_length : int, optional
        Of the batch method; by default it suits n (Table 1).
    helping : bool, optional
        With "batch": searching threads that find the queue full finish locations in it (section 3.3, the
        variant of the paper's reviewer).
    tested : "outer" or "all", optional
        With "circumcircle": before a flip test the triangles that other threads may change, the default, or
        also those of the thread's own star (section 3.4).
    head_start : bool, optional
        With "circumcircle": let one thread insert the first sites of all parts alone, the default.

    Attributes
    ----------
    points : float64 (n, 2)
        The sites as given.
    simplices, triangles : int32 (m, 3)
        One array under two names: the triangles, counter-clockwise.
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

    stats: Statistics
    """Counts and times."""

    _name: ClassVar[str] = "dt3d.threaded2d.Delaunay"

    def __init__(
        self,
        points2d: PointsLike,
        *,
        method: PlaneMethod = "auto",
        threads: int | None = None,
        order: Order | None = None,
        location: Location = "dag",
        subdivision: Subdivision = "random",
        seed: int = 0,
        **options: Unpack[PlaneOptions],
    ) -> None:
        begun = time.perf_counter()
        check_names(options, PlaneOptions.__annotations__, "threaded2d.Delaunay")
        chosen = order or ("brio" if options.get("preset") is None else "random")
        word = check_plane_options(method, threads, chosen, location, subdivision, seed)
        check_values(options, method, location)
        points = check_points(points2d, 2)
        sites = exactly_scaled(points)
        run = configured(
            len(sites),
            method=method,
            threads=threads,
            order=chosen,
            location=location,
            subdivision=subdivision,
            seed=word,
            **options,
        )
        prepared = time.perf_counter()
        self._take_triangles(points, triangulate(sites, run), begun, prepared)

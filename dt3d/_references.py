"""What to cite: the software, and the papers whose methods it runs; `dt3d.references()`."""

from __future__ import annotations

from typing import NamedTuple


class Reference(NamedTuple):
    """A paper, and what of it is here."""

    authors: str
    title: str
    where: str
    used_for: str

    def __str__(self) -> str:
        return f"{self.authors}: {self.title}. {self.where}. Here: {self.used_for}."


_PAPERS = (
    Reference(
        "Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo",
        "A Data-parallel Algorithm for Three-dimensional Delaunay Triangulation and its Implementation",
        "Supercomputing '93, 112-121",
        'method="extrapolation", preset="teng1993"',
    ),
    Reference(
        "J. Kohout, I. Kolingerova, J. Zara",
        "Practically oriented parallel Delaunay triangulation in E2 for computers with shared memory",
        "Computers & Graphics 28, 2004",
        "dt3d.threaded2d",
    ),
    Reference(
        "A. Bowyer; D. F. Watson",
        "Computing Dirichlet tessellations; Computing the n-dimensional Delaunay tessellation",
        "The Computer Journal 24, 1981, 162-166; 167-172",
        "insertion",
    ),
    Reference(
        "N. Amenta, S. Choi, G. Rote",
        "Incremental constructions con BRIO",
        "SoCG 2003",
        "the order of insertion",
    ),
    Reference(
        "O. Devillers, M. Teillaud",
        "Perturbations and vertex removal in a 3D Delaunay triangulation",
        "SODA 2003",
        "ties between cospherical sites",
    ),
    Reference(
        "R. Sibson",
        "A brief description of natural neighbour interpolation",
        "Interpreting Multivariate Data, 1981, 21-36",
        "dt3d.interpolate.NaturalNeighbor",
    ),
    Reference(
        "H. Edelsbrunner, E. P. Mücke",
        "Three-dimensional Alpha Shapes",
        "ACM Transactions on Graphics 13, 1994",
        "alpha_shape, alpha_complex",
    ),
    Reference(
        "G. E. Blelloch",
        "Vector Models for Data-Parallel Computing",
        "MIT Press, 1990",
        "scanvec",
    ),
)


class References(tuple[Reference, ...]):
    """References; printed, one a line."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "\n".join(map(str, self))


def references() -> References:
    """The papers whose methods are here, to be cited where they are used; ``CITATION.cff`` has the software.

    Returns
    -------
    References
        A tuple that is printed as one line for each.

    Examples
    --------
    >>> import dt3d
    >>> dt3d.references()[1].title
    'Practically oriented parallel Delaunay triangulation in E2 for computers with shared memory'
    """
    return References(_PAPERS)

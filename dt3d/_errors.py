"""What dt3d raises beside the ValueErrors of its input contract."""

from __future__ import annotations


class DegenerateInputError(ValueError):
    """The sites span no volume, or in 2D no area: too few distinct ones, or all on a plane, a line, a point.

    Attributes
    ----------
    dimension : int
        Of the sites' affine hull: 0, 1 or 2; 3 where there is volume.

    Examples
    --------
    >>> import dt3d
    >>> try:
    ...     dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    ... except dt3d.DegenerateInputError as error:
    ...     print(error.dimension)
    2
    """

    def __init__(self, message: str, dimension: int) -> None:
        super().__init__(message)
        self.dimension = dimension


class InconsistencyError(RuntimeError):
    """The method cannot finish the set: too many tetrahedra contradict each other.

    Attributes
    ----------
    inconsistencies : int
        How many there were when it stopped.
    """

    def __init__(self, message: str, inconsistencies: int) -> None:
        super().__init__(message)
        self.inconsistencies = inconsistencies


class InconsistencyWarning(RuntimeWarning):
    """The result has inconsistencies: tetrahedra were left out, so it may have holes or overlaps."""


class QuadraticSearchWarning(RuntimeWarning):
    """Extrapolation compares each of thousands of faces with thousands of sites, as on one sphere."""


class InternalError(RuntimeError):
    """A fault of dt3d itself: something happened that no right run can do. The message asks for a report.

    Raised in place of an endless loop or of a wrong result, for example where a walk takes more steps than
    there are tetrahedra.
    """

    def __init__(self, what: str) -> None:
        super().__init__(
            f"{what}. This is a fault of dt3d, not of the input; please report it, with the points if you can"
        )

"""The options of `scipy.spatial.Delaunay` and `Voronoi`: what they do here, or why they cannot be served."""

from __future__ import annotations

import numpy as np

# Options of Qhull that say how it rounds, scales, merges or reports: the result here is exact, so that they
# change nothing.
NO_EFFECT = {
    "Qbb",
    "QbB",
    "Qc",
    "Qi",
    "Qs",
    "Qt",
    "Qx",
    "Qz",
    "Q3",
    "Q5",
    "Q6",
    "Q8",
    "Q11",
    "Q12",
    "Q14",
    "Pp",
}
REFUSED = {
    "QJ": "it moves the sites at random, and nothing has to be moved here",
    "Qu": "furthest sites are not triangulated here",
    "Qv": "Qhull's own tests are not run here; tri.verify() proves the result",
}


def check_scipy_options(
    furthest_site: object, incremental: object, qhull_options: object, name: str, grows: bool = False
) -> bool:
    """Check what SciPy's class ``name`` takes in these places; whether sites are to be added later.

    ``grows`` says whether they can be.

    Raises
    ------
    ValueError
        If it asks for what cannot be served; the message says what can.
    """
    if _flag("furthest_site", furthest_site):
        msg = (
            f"furthest_site=True is not served: here circumspheres are empty, there all sites are inside; "
            f"scipy.spatial.{name} serves it"
        )
        raise ValueError(msg)
    growing = _flag("incremental", incremental)
    if growing and not grows:
        msg = (
            f"incremental=True is not served yet: a finished diagram takes no more sites. Make a new one of "
            f"all sites, or of dt3d.Delaunay(points, incremental=True); scipy.spatial.{name} serves it"
        )
        raise ValueError(msg)
    if qhull_options is None:
        return growing
    if isinstance(qhull_options, bytes):
        qhull_options = qhull_options.decode("latin1")
    if not isinstance(qhull_options, str):
        msg = f"qhull_options must be a str of options, such as 'Qbb Qc', or None, got {qhull_options!r}"
        raise ValueError(msg)
    for option in qhull_options.split():
        if option in NO_EFFECT:
            continue
        why = REFUSED.get(option, f"those that change nothing here are {' '.join(sorted(NO_EFFECT))}")
        msg = f"qhull_options={qhull_options!r}: {option} is not served; {why}"
        raise ValueError(msg)
    return growing


def _flag(name: str, value: object) -> bool:
    if not isinstance(value, bool | np.bool_):
        msg = f"{name} must be True or False, got {value!r}"
        raise ValueError(msg)
    return bool(value)

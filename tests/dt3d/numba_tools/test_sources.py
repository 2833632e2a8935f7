"""What a module imports from its package is found in its source; `test_kernel_cache` has the real modules."""

from dt3d._numba.sources import fingerprint, imported

SOURCE = """
from . import double_double as dd, missing
from .big_integers import (
    in_sphere_exact,  # a name
)
import dt3d.predicates.plane as plane, numpy
def f():
    from .arrays import orient2d
"""


def test_imports_at_the_beginning_of_lines():
    found = imported(SOURCE, "dt3d.predicates.space", False)
    package = "dt3d.predicates"
    expected = {package, f"{package}.double_double", f"{package}.big_integers", f"{package}.plane"}
    assert found == expected


def test_modules_have_fingerprints_of_their_own():
    plane, space = fingerprint("dt3d.predicates.plane"), fingerprint("dt3d.predicates.space")
    assert plane != space
    assert plane == fingerprint("dt3d.predicates.plane")

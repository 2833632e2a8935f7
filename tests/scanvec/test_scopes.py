"""Names of phases and operations."""

import pytest

from scanvec._ledger.scopes import Scopes


def test_the_innermost_phase_and_the_outermost_operation():
    scopes = Scopes()
    assert (scopes.phase, scopes.visit, scopes.operation("map")) == ("", 0, "map")
    for visit in (1, 2):
        operations = scopes.in_operation("union"), scopes.in_operation("sort")
        with scopes.in_phase("outer"), scopes.in_phase("inner"), operations[0], operations[1]:
            assert (scopes.phase, scopes.visit, scopes.operation("map")) == ("inner", visit, "union")
    assert scopes.phase == ""


def test_an_error_ends_them():
    scopes = Scopes()
    with pytest.raises(ZeroDivisionError), scopes.in_phase("a"), scopes.in_operation("b"):
        raise ZeroDivisionError
    assert (scopes.phase, scopes.operation("map")) == ("", "map")

"""Names and forms of the last release give what the new ones give, and a warning that names these."""

import re

import numpy as np
import pytest

import scanvec as sv

from .cases import MACHINES

M = MACHINES[3]
V = M.vector([4, 5, 6])
TO = M.vector([2, 0, 1])
FLAGS = M.vector([True, False, True])

FORMS = [
    (lambda: sv.select(FLAGS, V, TO), lambda: sv.where(FLAGS, V, TO), "select will go; use where"),
    (lambda: sv.permute(V, TO, into=V), lambda: sv.scatter(V, TO, into=V), "use scatter(v, index, into=...)"),
    (
        lambda: sv.permute(V, TO, into=TO, where=FLAGS),
        lambda: sv.scatter(V, TO, into=TO, where=FLAGS),
        "use scatter(v, index, into=...)",
    ),
    (lambda: sv.send(V, TO, sv.ADD, V), lambda: sv.send(V, TO, sv.ADD, into=V), "into=into)"),
    (lambda: M.send(V, TO, sv.ADD, V), lambda: M.send(V, TO, sv.ADD, into=V), "into=into)"),
    (lambda: sv.get(V, TO, where=FLAGS), lambda: sv.get(V, TO, where=FLAGS, otherwise=0), "use otherwise=0"),
    (lambda: M.get(V, TO, where=FLAGS), lambda: M.get(V, TO, where=FLAGS, otherwise=0), "use otherwise=0"),
    (lambda: sv.scan(record=V, op=sv.ADD), lambda: sv.scan(V, sv.ADD), "scan(record=...) will go; use v=..."),
    (
        lambda: sv.flag_merge(M.vector([1]), second=M.vector([2, 3]), flags=FLAGS),
        lambda: sv.flag_merge(M.vector([1]), M.vector([2, 3]), FLAGS),
        "(second=...) will go; use w=...",
    ),
]


@pytest.mark.parametrize(("old", "new", "text"), FORMS, ids=[text for _, _, text in FORMS])
def test_old_forms_give_the_same_and_warn_the_caller(old, new, text):
    with pytest.warns(DeprecationWarning, match=re.escape(text)) as caught:
        got = old()
    assert {warning.filename for warning in caught} == {__file__}
    assert np.array_equal(got, new())


def test_instances_have_names_of_instances():
    with pytest.warns(DeprecationWarning, match="Hypercube will go; use HYPERCUBE"):
        assert sv.Hypercube is sv.HYPERCUBE
    with pytest.warns(DeprecationWarning, match="Mesh2D will go; use MESH2D"):
        assert sv.Mesh2D is sv.MESH2D
    with pytest.raises(AttributeError, match="no attribute 'Torus'"):
        sv.Torus  # noqa: B018


def test_what_a_new_form_lacks_is_an_error():
    with pytest.raises(TypeError, match="into"):
        sv.scatter(V, TO)
    with pytest.raises(TypeError, match="where"):
        sv.permute(V, TO, where=FLAGS)

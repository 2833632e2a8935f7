"""First facets are checked, and repaired if none is right."""

import numpy as np
import pytest

import dt3d
from dt3d.extrapolation import loop
from dt3d.extrapolation.exact.first_facets import checked_facets
from dt3d.extrapolation.warrants import NO_SITE

from ...exact import validate
from ...families import tetrahedra
from .modes import MACHINE, SETS, exact_sites, lexicographic


@pytest.mark.parametrize("name", ["uniform", "lattice", "tenths"])
def test_wrong_first_facets_are_repaired(name, monkeypatch):
    """b is right and c the site furthest from both: facets that hardly ever are Delaunay."""
    real = loop.first_facets
    wrong = []

    def far_off(buckets):
        a, b, _ = real(buckets)
        sites = np.stack([v.to_numpy() for v in buckets.sites], axis=1)
        ends = sites[a.to_numpy()], sites[b.to_numpy()]
        distance = sum(np.linalg.norm(sites - e[:, None], axis=2) for e in ends)
        wrong.append((a, b, MACHINE.vector(distance.argmax(axis=1).astype(np.int32))))
        return wrong[-1]

    monkeypatch.setattr(loop, "first_facets", far_off)
    points = lexicographic(SETS[name])
    tri = dt3d.Delaunay(points, machine=MACHINE)
    assert len(wrong) == 1
    validate(tri)
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(dt3d.Delaunay(points)))


def test_checked_facets_are_delaunay():
    points = lexicographic(SETS["lattice"])
    exact = exact_sites(points)
    start, counts = checked_facets(exact, loop.initial_facets(exact.buckets))
    origin = exact.buckets.origin.to_numpy()
    faces = origin[np.stack([v.to_numpy() for v in start.faces], axis=1)]
    site = start.site.to_numpy()
    found = np.c_[faces, origin[site]][site != NO_SITE]
    want = {tuple(sorted(t)) for t in dt3d.Delaunay(points).simplices.tolist()}
    assert len(found)
    assert {tuple(sorted(t)) for t in found.tolist()} <= want
    assert counts.face_expansions >= len(faces)

"""Face expansion in both forms, against the centres of all spheres."""

import numpy as np
import pytest

import scanvec as sv
from dt3d.extrapolation.exact.expansion import FILTERED, open_face
from dt3d.extrapolation.expansion import expand_perturbed, search_faces
from dt3d.extrapolation.faces import Face
from dt3d.extrapolation.warrants import NO_SITE

from .searching import MACHINE, RNG, SETS, fourth_vertex, in_order


@pytest.mark.parametrize("name", SETS)
def test_face_expansion(name, load):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    faces = np.array([RNG.permutation(len(sites))[:3] for _ in range(60)], np.int32)  # mostly long ones
    faces = Face(*(MACHINE.vector(f.copy()) for f in faces.T))
    want = [fourth_vertex(sites, *face) for face in np.stack([v.to_numpy() for v in faces], axis=1)]
    answer = expand_perturbed(buckets, faces)
    np.testing.assert_array_equal(answer.best.site.to_numpy(), want)

    corners = [sv.get(buckets.sites, v) for v in faces]
    queries = MACHINE.map(open_face, faces, *corners, False)
    bounded = search_faces(buckets, queries, corners, FILTERED).best
    decided = bounded.second.to_numpy() > bounded.high.to_numpy()
    assert decided.sum() >= np.count_nonzero(np.array(want) != NO_SITE) - 1
    np.testing.assert_array_equal(bounded.site.to_numpy()[decided], np.array(want)[decided])

"""Rounded spheres: a comparison with them is a proof, and every tetrahedron is proved positive."""

from fractions import Fraction

import numpy as np
import pytest

from dt3d.insertion import spheres
from dt3d.insertion.mesh import bundle, site_at_hand, squared_distance, squared_radii
from dt3d.insertion.worker import scratch_for
from dt3d.predicates import work_array

from ..exact import in_sphere, integers, orient
from .growing import rows_of, site


def star_of_one(points):
    """The star of site 0 with one facet, sites 1, 2, 3."""
    mesh = bundle(rows_of(points), np.zeros(8, np.uint32), np.zeros(4))
    scratch = scratch_for(4)
    relative = points[1:4] - points[0]
    scratch.vertices[1:] = 1, 2, 3
    scratch.x[1:], scratch.y[1:], scratch.z[1:] = relative.T
    scratch.squared[1:] = (relative**2).sum(axis=1)
    scratch.rim[:, 0], scratch.slots[0] = (1, 2, 3), 0
    return mesh, scratch


@pytest.mark.parametrize("height", [1.0, 1e-6, 1e-12])
@pytest.mark.parametrize("seed", range(20))
def test_what_a_comparison_says_is_true(seed, height):
    """Sites on the sphere, up to rounding, and beside it; the flatter the tetrahedron the wider the doubt."""
    rng = np.random.default_rng(seed)
    points = rng.random((4, 3)) * [1, 1, height]
    if orient(*integers(points)) < 0:
        points[[1, 2]] = points[[2, 1]]
    mesh, scratch = star_of_one(points)
    if spheres.round_spheres(mesh, site_at_hand(mesh, 0), scratch, 1, 1.0):
        assert height < 1
        return
    (below, above), center = squared_radii(mesh)[0].tolist(), mesh.spheres[:3]
    exact = [Fraction(x) for x in center.tolist()]
    for p in points:
        assert (
            Fraction(below)
            < sum((Fraction(x) - c) ** 2 for x, c in zip(p.tolist(), exact, strict=True))
            < above
        )
    out = rng.standard_normal((300, 3))
    out /= np.linalg.norm(out, axis=1)[:, None]
    gap = rng.choice([-1, 1], (300, 1)) * 2.0 ** rng.integers(-52, 0, (300, 1))
    near = center + out * np.sqrt(above) * (1 + gap)
    decided = 0
    for p in near:
        squared = squared_distance(mesh, 0, site([p], 0))
        if squared < below or squared > above:
            decided += 1
            assert (squared < below) == (in_sphere(*integers(np.concatenate([points, [p]]))) > 0)
    assert decided > (100 if height == 1 else 0)


@pytest.mark.parametrize("scale", [1.0, 2.0**-80])
@pytest.mark.parametrize(("corner", "is_flat"), [(1.0, False), (0.0, True), (-1.0, True)])
def test_every_tetrahedron_of_a_star_is_proved_positive(scale, corner, is_flat):
    """By its sphere, or by exact arithmetic: on the small scale, where there are no spheres, for all."""
    points = scale * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, corner]])
    mesh, scratch = star_of_one(points)
    s, w = site_at_hand(mesh, 0), work_array(points)
    assert spheres.round_spheres(mesh, s, scratch, 1, 1.0) == (is_flat or scale < 1)
    assert spheres.flat(mesh, 0, scratch, 1, w) == is_flat
    # beyond a hull facet lies a ghost, which is not flat
    scratch.rim[2, 0] = 0
    assert spheres.round_spheres(mesh, s, scratch, 1, 1.0) == 1
    assert not spheres.flat(mesh, 0, scratch, 1, w)
    assert squared_radii(mesh)[0].tolist() == [-1, np.inf]


def test_nothing_is_proved_of_coordinates_of_any_magnitude():
    mesh, scratch = star_of_one(np.concatenate([np.zeros((1, 3)), np.eye(3)]))
    assert spheres.round_spheres(mesh, site_at_hand(mesh, 0), scratch, 1, np.inf) == 0
    assert squared_radii(mesh)[0, 1] == np.inf

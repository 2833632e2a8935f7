"""First facets, against brute force."""

import numpy as np
import pytest

from dt3d.extrapolation.gift_wrapping import first_facets

from .searching import SETS, in_order


def circumradii(a, b, c):
    """Circumradii of the triangles a, b, c[i] by Heron's formula; inf where flat."""
    u, v, w = np.linalg.norm(b - a), np.linalg.norm(c - a, axis=1), np.linalg.norm(c - b, axis=1)
    s = (u + v + w) / 2
    area = np.sqrt(np.maximum(s * (s - u) * (s - v) * (s - w), 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(area > 0, u * v * w / (4 * area), np.inf)


@pytest.mark.parametrize("name", SETS)
def test_first_facets(name, load):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    a, b, c = (v.to_numpy() for v in first_facets(buckets))
    np.testing.assert_array_equal(a, np.arange(len(sites)))
    for i, j, k in zip(a, b, c, strict=True):
        radii = circumradii(sites[i], sites[j], sites)
        radii[[i, j]] = np.inf
        assert len({i, j, k}) == 3
        assert radii[k] <= radii.min() * (1 + 1e-6)  # Heron's formula loses half the digits of flat triangles

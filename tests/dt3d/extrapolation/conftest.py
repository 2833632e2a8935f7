"""Searches through cells or through a tree."""

import numpy as np
import pytest

from dt3d.extrapolation import buckets as buckets_module
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.points import Point

from .searching import MACHINE


@pytest.fixture(params=["cells", "tree"])
def load(request, monkeypatch):
    """Buckets of points, whose searches go through cells or through a tree."""
    monkeypatch.setattr(buckets_module, "EVENNESS", np.inf if request.param == "cells" else 0)
    return lambda points: bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T)))

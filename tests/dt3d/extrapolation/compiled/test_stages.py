"""Faces go from stage to stage and come to an end."""

import jax.numpy as jnp
import numpy as np
import pytest

from dt3d.extrapolation.compiled.stages import FOUND, HULL, TIE, WIDER, WIDER_STAGE, Stage, settle
from dt3d.extrapolation.warrants import NO_SITE


def test_faces_go_to_later_stages():
    assert set(WIDER_STAGE) == set(Stage)
    assert all(to > stage for stage, to in WIDER_STAGE.items() if stage != Stage.VECTORS)


@pytest.mark.parametrize(
    ("covered", "alone", "some", "status"),
    [
        (True, True, True, FOUND),
        (True, True, False, HULL),
        (True, False, True, TIE),
        (False, True, True, WIDER),
    ],
)
def test_what_becomes_of_a_face(covered, alone, some, status):
    flags = (jnp.array([x]) for x in (covered, alone, some))
    out = settle(*flags, jnp.array([5]), jnp.array([1.0]), jnp.array([2.0]))
    assert int(out.status[0]) == status
    assert int(out.site[0]) == (5 if status == FOUND else NO_SITE)
    assert float(out.low[0]) == (1.0 if status in (FOUND, HULL) else -np.inf)

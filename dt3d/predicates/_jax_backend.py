"""Signs of many cases by the predicates in JAX, all at once."""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import numpy as np

from . import elementwise
from .integers import limbs_of


def signs(predicate: str, cases: np.ndarray) -> np.ndarray:
    """int8 (m,) of cases float64 (m, k, d)."""
    count, k, d = cases.shape
    digits = limbs_of(cases.reshape(-1, d)).reshape(-1, count, k, d)
    # the next power of two, so that few lengths are compiled
    room = 1 << max(count - 1, 0).bit_length()
    digits = np.pad(digits, [(0, 0), (0, room - count), (0, 0), (0, 0)])
    with jax.enable_x64(True):
        return np.asarray(_all(predicate, digits))[:count].astype(np.int8)


@partial(jax.jit, static_argnums=0)
def _all(predicate: str, digits: Any) -> Any:
    length, _, k, d = digits.shape
    points = [
        tuple(tuple(digits[i, :, j, c] for i in range(length)) for c in range(d)) for j in range(k)
    ]
    return jax.vmap(getattr(elementwise, predicate))(*points)

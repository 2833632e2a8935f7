"""Signs of many cases by the predicates in JAX, all at once."""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import numpy as np

from scanvec._running import computing

from . import determinants
from ._mapped import in_blocks
from .integers import limbs_of


def signs(predicate: str, cases: np.ndarray) -> np.ndarray:
    """int8 (m,) of cases float64 (m, k, d)."""
    count, k, d = cases.shape
    digits = limbs_of(cases.reshape(-1, d))
    digits = np.moveaxis(digits.reshape(len(digits), count, k, d), 1, -1)
    # the next power of two, so that few lengths are compiled
    room = 1 << max(count - 1, 0).bit_length()
    digits = np.pad(digits, [(0, 0), (0, 0), (0, 0), (0, room - count)])
    with computing():
        return np.asarray(_signs(predicate, digits))[:count].astype(np.int8)


@partial(jax.jit, static_argnums=0)
def _signs(predicate: str, digits: Any) -> Any:
    return in_blocks(getattr(determinants, predicate), digits)

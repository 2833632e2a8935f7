"""The search through the tree ends."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest

import dt3d
from dt3d.extrapolation.gift_wrapping import NEAREST, Start
from dt3d.extrapolation.tree import search as tree_search

from ..searching import MACHINE, buckets_of


def test_a_search_whose_bounds_are_no_numbers():
    sites = np.random.default_rng(0).random((60, 3))
    buckets = buckets_of(sites)
    queries = Start(buckets.sites, MACHINE.iota(len(sites)))
    spec = replace(NEAREST, trial_bound=lambda query, k: jnp.full_like(query.a.x, jnp.nan))
    assert len(tree_search.search(buckets, queries, NEAREST).best.site) == 60
    with pytest.raises(dt3d.InternalError, match="60 of 60 searches in a tree do not end"):
        tree_search.search(buckets, queries, spec)

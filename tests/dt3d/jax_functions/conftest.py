"""Tests of what only CPUs do, on a machine that has another device."""

import jax
import pytest


@pytest.fixture
def on_cpu():
    """Let JAX run on the CPU."""
    with jax.default_device(jax.devices("cpu")[0]):
        yield

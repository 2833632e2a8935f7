"""The example algorithm, connected components, against a search by SciPy."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

import scanvec as sv

EXAMPLE = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "write_your_own_algorithm.py"))


@pytest.mark.parametrize("machine", [sv.Simulated(4), sv.Device()], ids=["P=4", "device"])
@pytest.mark.parametrize(("n", "m"), [(1, 0), (2, 1), (50, 20), (50, 40), (50, 200)])
def test_components(machine, n, m):
    edges = np.random.default_rng([n, m]).integers(0, n, (m, 2))
    root, _ = EXAMPLE["components"](machine, n, edges)
    count, label = connected_components(coo_matrix((np.ones(m), edges.T), (n, n)), directed=False)
    assert EXAMPLE["count_components"](root) == count
    # the two labellings are one partition
    assert len(set(zip(root.to_numpy().tolist(), label.tolist(), strict=True))) == count

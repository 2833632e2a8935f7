"""What the compiled steps make of a set, and what it must be equal to."""

import jax
import jax.numpy as jnp
import numpy as np

import dt3d
import scanvec as sv
from dt3d._input import exactly_scaled, first_copies
from dt3d._topology import OUTWARD
from dt3d.extrapolation.compiled import loop, tables
from dt3d.extrapolation.compiled.stages import Batch
from dt3d.extrapolation.exact.canonical import in_canonical_order
from dt3d.extrapolation.faces import Face
from dt3d.extrapolation.warrants import NO_SITE
from dt3d.verification import verify

from ...families import tetrahedra


def random_set(n):
    return np.random.default_rng(n).random((n, 3))


def compiled(points, **sizes):
    """What the compiled steps alone make of a set, as the public class would have it, and the run."""
    used, _ = first_copies(points)
    with jax.enable_x64(True):
        run = loop.Loop(sv.Device(), exactly_scaled(points[used]), **sizes)
        found = in_canonical_order(run.run(None))
    found.simplices = used[found.simplices].astype(np.int32)
    return found, run


def assert_equal_to_insertion(points, found):
    want = dt3d.Delaunay(points, method="insertion")
    found.points = points
    np.testing.assert_array_equal(tetrahedra(found), tetrahedra(want))
    report = verify(
        points, found.simplices, neighbors=found.neighbors, duplicates=want.duplicates, perturbed=True
    )
    assert report, report


def outward_faces(points, count):
    """Cells of sites in lexicographic order, a batch of faces of their hull and interior, and the answers."""
    sites = np.unique(points, axis=0)
    cells = tables.in_cells(exactly_scaled(sites))
    tri = dt3d.Delaunay(sites, method="insertion")
    number = np.argsort(cells.order).astype(np.int32)
    faces = number[tri.simplices[:, OUTWARD].reshape(-1, 3)]
    beyond = tri.neighbors.ravel()
    mirror = (tri.neighbors[beyond] == np.repeat(np.arange(len(tri.simplices)), 4)[:, None]).argmax(axis=1)
    want = np.where(beyond < 0, NO_SITE, number[tri.simplices[beyond, mirror]])
    hull = np.flatnonzero(beyond < 0)[: count // 2]
    chosen = np.concatenate([hull, np.flatnonzero(beyond >= 0)[: count - len(hull)]])
    padded = np.zeros((3, cells.layout.wave), np.int32)
    padded[:, : len(chosen)] = faces[chosen].T
    bound = jnp.full(cells.layout.wave, jnp.inf, jnp.float64)
    face = Face(*map(jnp.asarray, padded))
    return cells, Batch(face.a, face, bound, jnp.int32(len(chosen))), want[chosen]

"""A triangulation made by hand, for what reads triangulations."""

from itertools import permutations
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def cube():
    """The unit cube as six tetrahedra about a diagonal, with one site that is not used.

    Not the library's class: what is tested with it (files, meshes, pictures) takes any object with these
    arrays.
    """
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    points = np.vstack([corners, corners[:1]])
    simplices = []
    for axes in permutations([4, 2, 1]):
        walk = np.cumsum([0, *axes])  # from corner 0 along the axes, in every order, to corner 7
        a, b, c, d = points[walk]
        simplices.append(walk if np.linalg.det([b - a, c - a, d - a]) > 0 else walk[[1, 0, 2, 3]])
    simplices = np.array(simplices, np.int32)

    faces = {}
    for t, vertices in enumerate(simplices):
        for k in range(4):
            faces.setdefault(frozenset(np.delete(vertices, k)), []).append((t, k))
    neighbors = np.full((6, 4), -1, np.int32)
    hull = []
    for sides in faces.values():
        (t, k), (u, j) = sides[0], sides[-1]
        if len(sides) == 2:
            neighbors[t, k], neighbors[u, j] = u, t
        else:
            hull.append(simplices[t][[[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]][k]])
    return SimpleNamespace(
        points=points,
        simplices=simplices,
        neighbors=neighbors,
        convex_hull=np.array(hull, np.int32),
        duplicates=np.array([[8, 0]], np.int32),
        iteration=np.array([1, 1, 1, 2, 2, 3], np.int32),
    )


@pytest.fixture
def shared_folder():
    """Point sets that lie beside the checkout on some machines; elsewhere the test is skipped."""
    folder = Path(__file__).parents[3] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"the point sets are not at {folder}")
    return folder


@pytest.fixture
def shared_points(shared_folder):
    """A loader of point sets (n, 3) by name."""

    def load(name):
        with np.load(shared_folder / f"{name}.npz") as file:
            return file["points"]

    return load


@pytest.fixture
def shared_cases(shared_folder):
    """A loader of predicate cases (m, k, d) and their signs (m,) by name."""

    def load(name):
        with np.load(shared_folder / f"{name}.npz") as file:
            return file["cases"], file["sign"]

    return load

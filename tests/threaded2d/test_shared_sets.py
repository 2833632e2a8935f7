"""Every real point set in the plane that lies beside the checkout, and terrains seen from above."""

from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d.threaded2d.input_subdivision import SUBDIVISIONS

from .families import assert_methods_agree, canonical

PARALLEL = ("batch", "circumcircle", "pessimistic", "optimistic")

FOLDER = Path(__file__).parents[3] / "shared" / "data"
FROM_ABOVE = (
    "crater_lake",
    "lidr_megaplot",
    "las_autzen_trim",
    "las_simple",
    "las_plane",
    "las_vegetation",
    "mr19_mock",
)


def sets_in_the_plane():
    found = []
    for path in sorted(FOLDER.glob("*.npz")):
        if path.stem.startswith("pred_"):
            continue
        with ZipFile(path) as archive:
            for member in archive.namelist():
                with archive.open(member) as stream:
                    np.lib.format.read_magic(stream)
                    shape = np.lib.format.read_array_header_1_0(stream)[0]
                if len(shape) == 2 and (shape[1] == 2 or path.stem in FROM_ABOVE):
                    found.append(f"{path.stem}:{member.removesuffix('.npy')}")
    return found or ["none:"]


def points_of(name):
    if not FOLDER.is_dir():
        pytest.skip(f"the point sets are not at {FOLDER}")
    stem, key = name.split(":")
    with np.load(FOLDER / f"{stem}.npz") as file:
        return file[key][:, :2]


@pytest.mark.parametrize("name", sets_in_the_plane())
def test_all_methods_agree_on_the_set(name):
    points = points_of(name)
    try:
        tri = threaded2d.Delaunay(points, method="sequential")
    except dt3d.DegenerateInputError as error:
        assert np.linalg.matrix_rank(points - points[0]) == error.dimension  # noqa: PT017
        return
    assert tri.verify(), tri.verify()
    want = canonical(tri.triangles)
    assert_methods_agree(points, want)


@pytest.mark.slow
@pytest.mark.parametrize("name", sets_in_the_plane())
def test_every_number_of_threads_and_subdivision_agrees_on_the_set(name):
    points = points_of(name)
    try:
        want = canonical(threaded2d.Delaunay(points, method="sequential").triangles)
    except dt3d.DegenerateInputError:
        for method in PARALLEL:
            with pytest.raises(dt3d.DegenerateInputError):
                threaded2d.Delaunay(points, method=method, threads=2)
        return
    few = len(points) <= 5000
    for method in PARALLEL:
        for threads in range(1 + (method == "batch"), 9):
            for i, subdivision in enumerate(SUBDIVISIONS):
                if few or i == threads % len(SUBDIVISIONS):
                    order = "brio" if subdivision == "curve" or threads % 2 else "random"
                    same = threaded2d.Delaunay(
                        points, method=method, threads=threads, order=order, subdivision=subdivision
                    )
                    np.testing.assert_array_equal(canonical(same.triangles), want)

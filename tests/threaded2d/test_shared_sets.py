"""Every real point set in the plane that lies beside the checkout, and terrains seen from above."""

from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d

from .families import canonical

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


@pytest.mark.parametrize("name", sets_in_the_plane())
def test_all_methods_agree_on_the_set(name):
    if not FOLDER.is_dir():
        pytest.skip(f"the point sets are not at {FOLDER}")
    stem, key = name.split(":")
    with np.load(FOLDER / f"{stem}.npz") as file:
        points = file[key][:, :2]
    try:
        tri = threaded2d.Delaunay(points, method="sequential")
    except dt3d.DegenerateInputError as error:
        assert np.linalg.matrix_rank(points - points[0]) == error.dimension  # noqa: PT017
        return
    assert tri.verify(), tri.verify()
    want = canonical(tri.triangles)
    for method, threads in (
        ("batch", 4),
        ("circumcircle", 2),
        ("optimistic", 3),
        ("pessimistic", 2),
        ("auto", 2),
    ):
        same = threaded2d.Delaunay(points, method=method, threads=threads)
        np.testing.assert_array_equal(canonical(same.triangles), want)

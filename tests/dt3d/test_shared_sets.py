"""Every real point set in space that lies beside the checkout: scans, models, crystals, proteins, terrain."""

from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

import dt3d

from .exact import check_indices, validate
from .families import tetrahedra

FOLDER = Path(__file__).parents[3] / "shared" / "data"
PLANAR = "grid5_planar3d"


def shape_in(archive, member):
    """The shape of an array in an .npz file, without reading the array."""
    with archive.open(member) as stream:
        np.lib.format.read_magic(stream)
        return np.lib.format.read_array_header_1_0(stream)[0]


def sets_in_space():
    """Names "file:array" and numbers of sites of all arrays (n, 3) but the planar one."""
    found = {}
    for path in sorted(FOLDER.glob("*.npz")):
        with ZipFile(path) as archive:
            for member in archive.namelist():
                shape = shape_in(archive, member)
                if len(shape) == 2 and shape[1] == 3 and path.stem != PLANAR:
                    found[f"{path.stem}:{member.removesuffix('.npy')}"] = shape[0]
    return found or {"none:": 0}  # which the fixture skips, and says why


SETS = sets_in_space()
every_set = pytest.mark.parametrize(
    "name", [pytest.param(s, marks=[pytest.mark.slow] if n > 15_000 else []) for s, n in SETS.items()]
)


@pytest.fixture
def points(name, shared_folder):
    stem, key = name.split(":")
    with np.load(shared_folder / f"{stem}.npz") as file:
        return file[key]


def checked(points):
    """The triangulation by insertion, proved, with every site in use or listed."""
    tri = dt3d.Delaunay(points, method="insertion")
    assert tri.verify(), tri.verify()
    check_indices(tri)
    if len(points) < 800:
        validate(tri)
    return tri


@every_set
def test_the_set_as_it_is_and_in_other_orders_and_scales(points):
    tri = checked(points)
    want = tetrahedra(tri)
    shuffled = np.random.default_rng(0).permutation(points)
    for same in (shuffled, np.ldexp(points, -200), np.ldexp(points, 200)):
        np.testing.assert_array_equal(tetrahedra(dt3d.Delaunay(same, method="insertion")), want)


@every_set
def test_the_set_rounded_by_scaling_and_moving(points):
    checked(points * 1e-9)
    checked(points * 1e9)
    checked(points + 1e6 * np.ptp(points, axis=0).max())


@pytest.mark.slow
@pytest.mark.parametrize("name", [s for s, n in SETS.items() if n <= 20_000])
def test_extrapolation_finds_what_insertion_does(points):
    tri = dt3d.Delaunay(points, method="extrapolation")
    check_indices(tri)
    want = dt3d.Delaunay(points, method="insertion")
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
def test_the_planar_set(method, shared_points):
    with pytest.raises(dt3d.DegenerateInputError, match="lie on a plane") as caught:
        dt3d.Delaunay(shared_points(PLANAR), method=method)
    assert caught.value.dimension == 2

"""Point sets of other projects' bug reports, with what is right for each; and many small sets in turn."""

from pathlib import Path

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d

from ..fuzz import oracle
from .families import grid

FOLDER = Path(__file__).parents[3] / "shared" / "cases"

# project and number: simplices, facets of the hull, duplicates; or the dimension of what spans no more
PLANE = {
    "GEOS#1286": (2, 4, 0),
    "Constrainautor#15_delaunator#94": (5, 5, 0),
    "hgeometry#28": (4, 4, 0),
    "hgeometry#209": (2, 4, 0),
    "Tinfour#53": (12, 4, 0),
    "ironwallaby#8": (3, 5, 0),
    "d3-delaunay#141_142": (10, 4, 0),
    "Deldir.jl#24": (48, 4, 0),
    "spade#109 f32": (7, 7, 0),
    "spade#98": (20, 4, 0),
    "bl4ckb0ne#32": (1, 3, 0),
    "rtriangulate#3 collinear": 1,
    "d3#48 collinear": 1,
    "gorhill#12": (1, 3, 0),
    "JTS#477a": (1, 3, 1),
    "JTS#477b": (5, 5, 0),
    "pyvista#4623": (10, 4, 0),
    "klayout#1996": (2, 4, 0),
    "eloraiby#1 10x10": (162, 36, 0),
    "R deldir_spade146": (1, 3, 0),
    "delaunator-rs#18": (4, 4, 0),
}
SPACE = {
    "MiniQhull#31_Quickhull#5 cube f32": (6, 12, 0),
    "MIConvexHull#44 cube": (6, 12, 0),
    "MIConvexHull#44 cube bent": (7, 12, 0),
    "scipy#8929 fcc noise": (30, 24, 0),
    "tritet#8 flat": 2,
    "meshpy#26 three": 2,
    "mpl#27735 plane": 2,
    "pytetgen#6 z=0": 2,
    "compas#206 z=0": 2,
    "MeshLib#6615 dup": (1, 4, 1),
    "geogram#108 octahedral 9": (17, 8, 0),
    "geogram#358 cone ring 8": (6, 14, 0),
    "geogram#358 cone ring 17": (15, 32, 0),
    "geogram#358 cone ring 64": (62, 126, 0),
    "geogram#358 cone ring 360": (358, 718, 0),
    "geogram#358 cone ring f32": (62, 126, 0),
    "gDel3D#14 sphere 1000": (2930, 1996, 0),
    "freud#841 int dup": (38528, 824, 25),
    "freud#128 3x3 z0": 2,
    "CGAL#2922 coplanar then volume": (3977, 3998, 0),
    "modflow#140 flat cloud": (30707, 208, 0),
    "sphere+antipodes exact lattice r": (164, 104, 0),
}
KINDS = {"reports2d": (threaded2d.Delaunay, PLANE), "reports3d": (dt3d.Delaunay, SPACE)}


def arrays(kind):
    path = FOLDER / f"{kind}.npz"
    if not path.is_file():
        pytest.skip(f"the sets are not at {path}")
    with np.load(path) as file:
        return {name: file[name] for name in file.files}


def simplices_of(tri):
    return tri.simplices if tri.points.shape[1] == 3 else tri.triangles


@pytest.mark.parametrize("kind", KINDS)
def test_every_report_has_an_answer(kind):
    assert set(arrays(kind)) == set(KINDS[kind][1])


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind in KINDS for name in KINDS[kind][1]])
def test_sets_that_others_reported(kind, name):
    points = arrays(kind)[name]
    triangulate, answers = KINDS[kind]
    if isinstance(answers[name], int):
        with pytest.raises(dt3d.DegenerateInputError) as caught:
            triangulate(points)
        assert caught.value.dimension == answers[name] == oracle.dimension(points)
        return
    tri = triangulate(points)
    assert (len(simplices_of(tri)), len(tri.convex_hull), len(tri.duplicates)) == answers[name]
    assert tri.verify(), tri.verify()
    if len(points) < 300:
        oracle.check(tri.points, simplices_of(tri), tri.neighbors, tri.duplicates)
    assert (tri.find_simplex(points) >= 0).all()


@pytest.mark.parametrize("d", [2, 3])
def test_many_small_sets_one_after_the_other(d):
    rng = np.random.default_rng(d)
    triangulate = dt3d.Delaunay if d == 3 else threaded2d.Delaunay
    for n in range(d + 2, d + 42):
        for points in (rng.random((n, d)), rng.integers(0, 4, (n, d)).astype(float), grid(3)[:, :d][:n]):
            try:
                tri = triangulate(points)
            except dt3d.DegenerateInputError as error:
                assert error.dimension == oracle.dimension(points) < d  # noqa: PT017
            else:
                oracle.check(tri.points, simplices_of(tri), tri.neighbors, tri.duplicates)

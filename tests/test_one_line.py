"""The tables of docs/one_line.md: the lines run, those of other libraries, too, and results are compared."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from .documents import page, programs, rows, run

PAGE = page("docs/one_line.md")
TABLES = {name: rows(PAGE, f"| what | {name} | dt3d |") for name in ("SciPy", "PyVista", "trimesh", "Open3D")}
LINES = [(library, *row) for library, table in TABLES.items() for row in table]

# not run: no library of these is among those of the tests
NOT_RUN = {"Open3D": "o3d.", "trimesh": ".contains("}


@pytest.fixture(scope="module")
def names(tmp_path_factory):
    """What the program at the head of the page defines, and the folder of its files."""
    folder = tmp_path_factory.mktemp("files")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(pv, "OFF_SCREEN", True)
        yield run(programs(PAGE)) | {"folder": folder}


def facets(simplices):
    """Rows of sites, whatever their order and that of a row."""
    return sorted(map(tuple, np.sort(simplices, axis=1).tolist()))


def same_facets(theirs, ours):
    assert facets(theirs) == facets(ours)


def same_numbers(theirs, ours):
    np.testing.assert_allclose(ours, theirs, rtol=1e-7, atol=1e-7)


def same_set(theirs, ours):
    assert set(np.ravel(theirs).tolist()) == set(np.ravel(ours).tolist())


def same_graph(theirs, ours):
    assert [sorted(part) for part in np.split(theirs[1], theirs[0])] == [
        sorted(part) for part in np.split(ours[1], ours[0])
    ]


def same_places(theirs, ours):
    order = [np.lexsort(places.round(6).T) for places in (theirs, ours)]
    np.testing.assert_allclose(ours[order[1]], theirs[order[0]], rtol=1e-6, atol=1e-6)


def same_cells(theirs, ours):
    """Their tetrahedra; VTK's alpha shapes have other cells, too."""
    same_facets(theirs.cells_dict[pv.CellType.TETRA], ours.cells_dict[pv.CellType.TETRA])
    assert ours.volume == pytest.approx(theirs.volume)


def nearly_the_terrain(theirs, ours):
    """VTK's is short of triangles at the border, with its default offset."""
    assert 0.98 * ours.n_cells < theirs.n_cells <= ours.n_cells
    assert ours.n_points == theirs.n_points


def same_surface(theirs, ours):
    assert ours.n_cells == theirs.n_cells
    assert ours.volume == pytest.approx(theirs.volume)


def same_sizes(theirs, ours):
    same_numbers(np.sort(np.abs(theirs)), np.sort(ours))


def same_within(theirs, ours):
    """Values inside; VTK takes a cell that has a point but for a tolerance, and outside the hull 0."""
    inside = ~np.isnan(ours)
    assert inside.sum() > 20
    np.testing.assert_allclose(ours[inside], theirs[inside], rtol=1e-3)


def same_level(theirs, ours):
    assert ours.n_points == theirs.n_points
    assert ours.area == pytest.approx(theirs.area, rel=1e-5)


def same_hull(theirs, ours):
    assert ours.is_watertight
    assert ours.volume == pytest.approx(theirs.volume)


def same_file(theirs, ours):
    """Both have written the file; the later one is ours, which PyVista reads."""
    assert pv.read("mesh.vtu").n_cells == 3062


def a_picture(theirs, ours):
    assert np.ptp(pv.read("inside.png")["PNGImage"]) > 0
    ours.close()


COMPARED = {
    "tetrahedra": same_facets,
    "triangles in the plane": same_facets,
    "which points are in the hull": same_set,
    "the sites that edges join with each": same_graph,
    "triangles of the convex hull": same_facets,
    "sites on the hull": same_set,
    "volume of the hull": same_numbers,
    "area of the hull": same_numbers,
    "Voronoi vertices": same_places,
    "Voronoi ridges in the plane": same_facets,
    "linear interpolation": same_numbers,
    "the same": same_numbers,
    "value of the nearest site": same_numbers,
    "smooth surfaces": same_numbers,
    "alpha shape": same_cells,
    "terrain": nearly_the_terrain,
    "surface of the hull": same_surface,
    "volumes of tetrahedra": same_sizes,
    "which points are in a cell": same_numbers,
    "values between the sites": same_within,
    "level set": same_level,
    "a file": same_file,
    "a picture of the inside": a_picture,
    "convex hull as a mesh": same_hull,
    "points of a file": same_numbers,
}


@pytest.mark.parametrize(
    ("library", "what", "theirs", "ours"), LINES, ids=[f"{library}, {what}" for library, what, *_ in LINES]
)
def test_line(library, what, theirs, ours, names, monkeypatch):
    monkeypatch.chdir(names["folder"])
    result = eval(_code(ours), dict(names))
    if theirs == "-" or NOT_RUN.get(library, "no such") in theirs or library == "Open3D":
        assert result is not None
        return
    # VTK leaves out flat tetrahedra at the hull by default, as the page says
    whole = _code(theirs).replace("delaunay_3d(", "delaunay_3d(offset=1000, ")
    compare = same_cells if (library, what) == ("PyVista", "tetrahedra") else COMPARED[what]
    compare(eval(whole, dict(names)), result)


def test_what_is_said_of_vtk(names):
    cloud = names["cloud"]
    by_default, whole = cloud.delaunay_3d(), cloud.dt3d.delaunay()
    assert (by_default.n_cells, whole.n_cells) == (2957, 3062)
    assert "2,957 tetrahedra are left of 3,062" in " ".join(PAGE.split())
    assert 1 - by_default.volume / whole.volume == pytest.approx(0.02, abs=0.005)


def _code(cell: str) -> str:
    """The line of a cell, without its backticks."""
    assert cell.startswith("`")
    assert cell.endswith("`")
    return cell.strip("`")

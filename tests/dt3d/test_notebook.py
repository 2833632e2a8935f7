"""What notebooks show: a table, and a drawing where it is small; nothing raises and nothing is loaded."""

import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import dt3d
from dt3d import _notebook

POINTS = np.random.default_rng(9).random((300, 3))
TRI = dt3d.Delaunay(POINTS)


def parsed(tri):
    """The cells of the table, and the triangles drawn."""
    root = ElementTree.fromstring(tri._repr_html_())  # well-formed
    rows = {row.find("th").text: row.find("td").text for row in root.iter("tr")}
    return rows, [path.get("fill") for path in root.iter("path")]


def test_in_space():
    rows, fills = parsed(TRI)
    assert rows["sites"] == "300"
    assert rows["tetrahedra"] == f"{len(TRI.simplices):,}"
    assert rows["facets of the hull"] == str(len(TRI.convex_hull))
    assert rows["method"] == "insertion"
    assert float(rows["seconds"]) == pytest.approx(TRI.stats.seconds["total"], rel=0.01)
    assert len(fills) > 50
    assert len(set(fills)) > 20


def test_in_the_plane_and_parts():
    plane = dt3d.Delaunay(POINTS[:, :2])
    rows, fills = parsed(plane)
    assert rows["triangles"] == str(len(plane.simplices))
    assert rows["edges of the hull"] == str(len(plane.convex_hull))
    assert len(fills) == len(plane.simplices)
    rows, fills = parsed(TRI.subset(np.arange(50)))
    assert rows["tetrahedra"] == "50"
    assert "method" not in rows
    assert fills
    assert parsed(TRI.subset([])) == (
        {"sites": "300", "tetrahedra": "0", "facets of the border": "0"},
        [],
    )


def test_duplicates_are_told():
    assert parsed(dt3d.Delaunay(np.vstack([POINTS, POINTS[:3]])))[0]["duplicates"] == "3"


@pytest.mark.parametrize("scale", [1e-300, 1e-5, 1e300])
def test_any_size_is_drawn(scale):
    for d in (2, 3):
        rows, fills = parsed(dt3d.Delaunay(POINTS[:100, :d] * scale))
        assert rows["sites"] == "100"
        assert fills


def test_far_away_points_have_a_table_at_least():
    assert parsed(dt3d.Delaunay(POINTS * 1e-3 + 1e12))[0]["sites"] == "300"


def test_large_ones_have_a_table_alone(monkeypatch):
    for name in ("MOST_SIMPLICES", "MOST_FACES"):
        with monkeypatch.context() as few:
            few.setattr(_notebook, name, 20)
            for tri in (TRI, dt3d.Delaunay(POINTS[:, :2])):
                rows, fills = parsed(tri)
                assert rows["sites"] == "300"
                assert not fills


def test_it_loads_no_viewer():
    program = (
        "import sys, dt3d, numpy as np\n"
        "dt3d.Delaunay(np.random.default_rng(0).random((50, 3)))._repr_html_()\n"
        "print([name for name in ('pyvista', 'vtkmodules', 'matplotlib', 'jax') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"

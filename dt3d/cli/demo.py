"""``dt3d demo``."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .._status import Printer
from .choice import Choice
from .report import say, stats_table
from .triangulate import in_space


def demo(*, out: Path = Path("out")) -> None:
    """Triangulate a large protein complex that comes with the package; write mtor.vtu and mtor.png.

    Parameters
    ----------
    out
        The folder for both files; made if it is not there.
    """
    from .._scene import Choice as Shown
    from .._space_picture import Panel, draw_picture
    from ..files import check_mesh_path, write_mesh
    from ..plot import check_picture_path
    from ..samples import mtor

    out.mkdir(parents=True, exist_ok=True)
    check_mesh_path(out / "mtor.vtu")
    check_picture_path(out / "mtor.png")
    console = Printer(highlight=False)
    points = mtor()
    console.print(f"{len(points):,} atoms of two mTOR-mLST8 complexes (PDB entry 4JSV)")
    tri = in_space(console, points, Choice(method="extrapolation"))
    console.print(stats_table(tri, "mTOR-mLST8, PDB entry 4JSV"))

    write_mesh(tri, out / "mtor.vtu")
    # edges longer than some bonds lead through what is no protein: voids, the gap, the room below the hull
    panels = [
        Panel(
            Shown(scalars="longest_edge", longest=np.inf, cut=0.5),
            "All tetrahedra, cut open",
            "longest edge in Å: short in the proteins, long in what is around them",
        ),
        Panel(
            Shown(scalars="depth", longest=6.0, cut=0.0),
            "Those with edges up to 6 Å: the proteins",
            "depth: facets to the hull; it is greatest in the clefts",
        ),
    ]
    headline = f"Delaunay triangulation of {len(points):,} atoms: two mTOR-mLST8 complexes, PDB entry 4JSV"
    draw_picture(tri, out / "mtor.png", panels, headline)
    say(console, f"wrote {out / 'mtor.vtu'} (for dt3d view, ParaView, PyVista) and {out / 'mtor.png'}")

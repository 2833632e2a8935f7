"""``dt3d demo``."""

from __future__ import annotations

import math
from pathlib import Path

from .choice import Choice
from .report import table_of
from .reporting import Reporting, Speaker
from .steps import Steps
from .triangulate import triangulated


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
    speaker = Speaker(Reporting())
    points = mtor()
    speaker.say(f"{len(points):,} atoms of two mTOR-mLST8 complexes (PDB entry 4JSV)")
    # edges longer than some bonds lead through what is no protein: voids, the gap, the room below the hull
    panels = [
        Panel(
            Shown(scalars="longest_edge", longest=math.inf, cut=0.5),
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
    with Steps(speaker.bars, ["triangulating", "writing", "drawing"]) as steps:
        tri = triangulated(speaker, steps, points, Choice(method="extrapolation"))
        speaker.show(table_of(tri, "mTOR-mLST8, PDB entry 4JSV"))
        with steps.step("writing"):
            write_mesh(tri, out / "mtor.vtu")
        with steps.step("drawing"):
            draw_picture(tri, out / "mtor.png", panels, headline)
    speaker.say(f"wrote {out / 'mtor.vtu'} (for dt3d view, ParaView, PyVista) and {out / 'mtor.png'}")

"""``dt3d demo``."""

from __future__ import annotations

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
    from ..files import check_mesh_path, write_mesh
    from ..plot import View, check_picture_path, draw
    from ..samples import mtor

    out.mkdir(parents=True, exist_ok=True)
    check_mesh_path(out / "mtor.vtu")
    check_picture_path(out / "mtor.png")
    speaker = Speaker(Reporting())
    points = mtor()
    speaker.say(f"{len(points):,} atoms of two mTOR-mLST8 complexes (PDB entry 4JSV)")
    with Steps(speaker.bars, ["triangulating", "writing", "drawing"]) as steps:
        tri = triangulated(speaker, steps, points, Choice(method="extrapolation"))
        speaker.show(table_of(tri, "mTOR-mLST8, PDB entry 4JSV"))
        with steps.step("writing"):
            write_mesh(tri, out / "mtor.vtu")
        views = [
            View("all tetrahedra, cut open", shrink=0.85),
            View("those with edges up to 6 Å: the proteins", shrink=0.9, cut=False, longest=6.0),
        ]
        with steps.step("drawing"):
            draw(tri, out / "mtor.png", views)
    speaker.say(f"wrote {out / 'mtor.vtu'} (for dt3d view, ParaView, PyVista) and {out / 'mtor.png'}")

"""``dt3d demo``."""

from __future__ import annotations

from pathlib import Path

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
    from ..files import check_mesh_path, write_mesh
    from ..plot import View, check_picture_path, draw
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
    views = [
        View("all tetrahedra, cut open", shrink=0.85),
        View("those with edges up to 6 Å: the proteins", shrink=0.9, cut=False, longest=6.0),
    ]
    draw(tri, out / "mtor.png", views)
    say(console, f"wrote {out / 'mtor.vtu'} (for dt3d view, ParaView, PyVista) and {out / 'mtor.png'}")

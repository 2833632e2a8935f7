"""``dt3d verify`` and ``dt3d view``: meshes from files."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from .._paths import check_apart
from .._status import NOT_DELAUNAY, Printer, Verdict
from .report import say
from .reporting import Reporting, Speaker
from .steps import Steps
from .streams import formats_of, incoming


def verify(
    file: Annotated[Path, Parameter(allow_leading_hyphen=True)],
    *,
    format: str | None = None,
    reporting: Reporting = Reporting(),  # noqa: B008  frozen
) -> None:
    """Prove with exact arithmetic that the tetrahedra of a mesh are a Delaunay triangulation of its points.

    Where a mesh has no tetrahedra, and triangles in the plane z = 0, those are proved. Prints a sentence for
    each invariant; the exit status is 1 if one is broken. Orientation breaks none.

    Parameters
    ----------
    file
        A mesh of tetrahedra, or of triangles in the plane, of either orientation: .vtu .vtk .npz .msh .mesh,
        and each of them with .gz; - is standard input
    format
        The format of what comes by - , as an extension: vtu, npz ...
    reporting
        What is said of it.
    """
    from ..reading.guarded import guarded
    from ..reading.plane import PlaneMesh, read_either

    speaker = Speaker(reporting)
    extension = formats_of(format, file).source
    with Steps(speaker.bars, ["reading", "verifying"], quiet=reporting.quiet) as steps:
        with steps.step("reading"), incoming(file, extension) as (path, called):
            mesh = guarded(read_either, path, called)
        with steps.step("verifying"):
            if isinstance(mesh, PlaneMesh):
                from ..threaded2d import verify as check_plane

                outcome = check_plane(mesh.points, mesh.triangles)
            else:
                from ..verification import verify as check_space

                outcome = check_space(mesh.points, mesh.simplices)
    verdict = "a Delaunay triangulation" if outcome else "NOT a Delaunay triangulation"
    for line in str(outcome).splitlines():
        speaker.say(line)
    speaker.say(f"{called}: {verdict}")
    invariants = [{"what": what, "broken": broken} for what, broken in outcome.invariants]
    speaker.result(
        {"file": str(called), "delaunay": bool(outcome), "invariants": invariants, "remarks": outcome.remarks}
    )
    if not outcome:
        raise Verdict(NOT_DELAUNAY)


def view(file: Path, *, screenshot: Path | None = None) -> None:
    """Show a mesh of tetrahedra in a window with a plane that cuts it open, or draw it into a file.

    Parameters
    ----------
    file
        A mesh of tetrahedra: .vtu .vtk .npz .msh .mesh, and each of them with .gz
    screenshot
        Draw into this file and open no window; works without a screen.
    """
    from .._mesh import show
    from ..files import read_mesh
    from ..plot import check_picture_path, draw

    if screenshot is not None:
        check_picture_path(screenshot)
        check_apart(screenshot, file)
    mesh = read_mesh(file)
    if screenshot is not None:
        draw(mesh, screenshot)
        say(Printer(highlight=False), f"wrote {screenshot}")
        return
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        msg = "there is no screen to open a window on; use --screenshot FILE.png"
        raise ValueError(msg)
    show(mesh, title=str(file))

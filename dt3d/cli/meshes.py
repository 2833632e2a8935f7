"""``dt3d verify`` and ``dt3d view``: meshes from files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from .._paths import check_apart
from .._status import NOT_DELAUNAY, Printer, Verdict, one_line
from .report import say
from .reporting import Reporting, Speaker
from .steps import Steps
from .streams import formats_of, incoming

if TYPE_CHECKING:
    import numpy as np

    from .._cell_data import Simplices


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


def view(
    file: Path,
    *,
    screenshot: Path | None = None,
    html: Path | None = None,
    scalar: str | None = None,
    longest: float | None = None,
    cut: float | None = None,
    azimuth: float | None = None,
) -> None:
    """Show a mesh cut open: in a window with sliders, as a page for browsers, or in a picture.

    Parameters
    ----------
    file
        A mesh of tetrahedra, or of triangles in the plane z = 0: .vtu .vtk .npz .msh .mesh, and each of them
        with .gz
    screenshot
        Draw into this file and open no window; works without a screen: .png .jpg, rendered, or .pdf .svg,
        which matplotlib paints, coloured by iteration or depth.
    html
        Write one page for browsers that has all it needs, with the controls of the window, and open none.
    scalar
        What colours show: depth, longest_edge, volume (in the plane area), circumradius, iteration; or data
        of the points by their name, of which vectors show as their length.
    longest
        Leave out what has a longer edge; inf leaves out nothing. By default nothing is, but where most of the
        hull is empty, as for points on surfaces, what is longer than five times the median.
    cut
        How much to cut away on the side of the eye, from 0 to 1; 0.5 by default, 0 where the default leaves
        out long tetrahedra.
    azimuth
        From where the eye looks, in degrees about the z axis; 35 by default.
    """
    from .._scene import Choice, Scene
    from ..plot import check_picture_path

    if screenshot is not None:
        check_picture_path(screenshot)
        check_apart(screenshot, file)
    if html is not None:
        from .._page import check_page_path

        check_page_path(html)
        check_apart(html, file)
    if screenshot is None and html is None:
        from .._display import check_screen

        check_screen()
    mesh = _shown(file)
    scene = Scene(mesh)
    choice = scene.chosen(Choice(scalars=scalar, longest=longest, cut=cut, azimuth=azimuth))
    console = Printer(highlight=False)
    if screenshot is not None:
        from .._space_picture import Panel, draw_picture

        draw_picture(mesh, screenshot, [Panel(choice)])
        say(console, f"wrote {screenshot}")
    if html is not None:
        from .._page import write_page

        for line in write_page(scene, choice, html, title=file.name):
            say(console, line)
    if screenshot is None and html is None:
        from .._window import show

        show(scene, choice, title=one_line(file))


def _shown(file: Path) -> Simplices:
    """The mesh of a file, in space or in the plane, with indices that are those of its points."""
    from .._mesh_input import check_simplices
    from ..reading.plane import PlaneMesh, read_either

    mesh = read_either(file, point_data=True)
    if not isinstance(mesh, PlaneMesh):
        return mesh
    try:
        triangles = check_simplices(mesh.triangles, len(mesh.points), 3, "triangles")
    except ValueError as error:
        msg = f"{file} is damaged: {error}"
        raise ValueError(msg) from None
    return Triangles(mesh.points, triangles, mesh.point_data)


@dataclass(frozen=True)
class Triangles:
    """Triangles in the plane, as `Scene` takes them."""

    points: np.ndarray
    simplices: np.ndarray
    point_data: Mapping[str, np.ndarray]

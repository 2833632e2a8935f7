"""``dt3d triangulate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import numpy as np
from cyclopts import Parameter

import dt3d

from .._options import Method, PlaneMethod
from .._paths import check_apart
from .._status import Printer, one_line
from .choice import Choice
from .report import Growth, ledger_table, plane_table, say, stats_table

if TYPE_CHECKING:
    import scanvec as sv

    from ..threaded2d import Delaunay


def triangulate(
    source: Path,
    *,
    output: Annotated[Path, Parameter(alias="-o")],
    choice: Choice = Choice(),  # noqa: B008  frozen
    picture: Path | None = None,
    force: bool = False,
) -> None:
    """Triangulate the points of a file: in space, or in the plane where they have two coordinates.

    Parameters
    ----------
    source
        Points: .npy .npz .csv .tsv .txt .dat .asc .pts .xyz .pdb .cif .mmcif .dump .lammpstrj .obj .off .node
        .ply .pcd .las .laz .stl .vtk .vtu .vtp .vti .vts .vtr .vtm .msh .mesh, and each of them with .gz
    output
        The mesh: .vtu .vtk .npz .msh .mesh hold the tetrahedra, .ply .stl the surface of the hull. In the
        plane all of them, .vtp and .obj hold the triangles.
    choice
        What is run.
    picture
        Also draw a picture: .png .jpg, or .pdf .svg, which matplotlib paints
    force
        Let the mesh replace the very file that the points are read from. Other files are replaced anyway.
    """
    from .._mesh_plane import check_plane_path, draw_plane, write_plane_mesh
    from .._space_picture import draw_picture
    from ..files import check_mesh_path, read_points, write_mesh
    from ..plot import check_picture_path

    # what cannot end well does not start
    choice.check_output(output)
    if picture is not None:
        check_picture_path(picture)
        check_apart(picture, output)
        check_apart(picture, source)
    if not force:
        check_apart(output, source, way_out="name another file, or say --force")
    machine = choice.make_machine()

    console = Printer(highlight=False)
    points = read_points(source, dimension=choice.dimension)
    choice.check_points(points, source)
    say(console, f"{len(points):,} points from {source}")
    if points.shape[1] == 2:
        check_plane_path(output)
        flat = in_plane(console, points, choice)
        console.print(plane_table(flat, one_line(source)))
        write_plane_mesh(flat, output)
        if picture is not None:
            draw_plane(flat, picture)
    else:
        check_mesh_path(output)
        tri = in_space(console, points, choice, machine)
        console.print(stats_table(tri, one_line(source)))
        if machine is not None and machine.ledger is not None:
            console.print(ledger_table(machine.ledger))
        write_mesh(tri, output)
        if picture is not None:
            draw_picture(tri, picture)
    say(console, f"wrote {output}" + (f" and {picture}" if picture is not None else ""))


def in_space(
    console: Printer, points: np.ndarray, choice: Choice, machine: sv.Machine | None = None
) -> dt3d.Delaunay:
    """Triangulate points in space, and print a line for each iteration."""
    inserts = machine is None and choice.robustness != "perturb" and choice.method != "extrapolation"
    with console.status("triangulating (the first iteration includes compilation)"):
        return dt3d.Delaunay(
            points,
            method=cast(Method, choice.method),  # checked with the points
            robustness=choice.robustness,
            machine=machine,
            threads=choice.threads,
            dtype=choice.dtype,
            seed=choice.seed,
            callback=Growth(console, "sites left" if inserts else "open faces"),
        )


def in_plane(console: Printer, points: np.ndarray, choice: Choice) -> Delaunay:
    """Triangulate points in the plane."""
    from .. import threaded2d

    with console.status("triangulating in the plane (the first time includes compilation)"):
        return threaded2d.Delaunay(
            points, method=cast(PlaneMethod, choice.method), threads=choice.threads, seed=choice.seed
        )

"""``dt3d triangulate``."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

from cyclopts import Parameter

import dt3d

from .._paths import check_apart
from .._status import NOT_DELAUNAY, Verdict, one_line
from .choice import Choice
from .report import Growth, ledger_table, result_of, table_of
from .reporting import Reporting, Speaker
from .steps import Steps
from .streams import STREAM, Formats, formats_of, incoming, outgoing

if TYPE_CHECKING:
    import numpy as np

    import scanvec as sv

    from .._options import Method, PlaneMethod  # loads NumPy, which the help does not need
    from ..files import Cloud


@Parameter(name="*", group="Delivery", negative=())
@dataclass(frozen=True)
class Delivery:
    """How the mesh is delivered.

    Attributes
    ----------
    format
        The format of what comes or goes by - , as an extension: csv, npy, vtu ... Where both do, two: csv,vtu
    compress
        Pack .vtu, .vtp and .npz: smaller files, which take longer to write.
    verify
        Prove the result, as `dt3d verify` does, before it is written.
    details
        Print also what the method counted.
    force
        Let the mesh replace the very file that the points are read from. Other files are replaced anyway.
    """

    format: str | None = field(default=None)
    compress: bool = field(default=False)
    verify: bool = field(default=False)
    details: bool = field(default=False)
    force: bool = field(default=False)


def triangulate(
    source: Annotated[Path, Parameter(allow_leading_hyphen=True)],
    *,
    output: Annotated[Path, Parameter(alias="-o", allow_leading_hyphen=True)],
    choice: Choice = Choice(),  # noqa: B008  frozen
    picture: Path | None = None,
    delivery: Delivery = Delivery(),
    reporting: Reporting = Reporting(),  # noqa: B008
) -> None:
    """Triangulate the points of a file: in space, or in the plane where they have two coordinates.

    What the file says of each point (temperatures, normals, classes ...)
    goes into .vtu .vtk .vtp .npz and .msh, in the order of the file. What
    the output cannot hold is named on standard error.

    Parameters
    ----------
    source
        Points: .npy .npz .csv .tsv .txt .dat .asc .pts .xyz .pdb .cif .mmcif .dump .lammpstrj .obj .off .node
        .ply .pcd .las .laz .stl .vtk .vtu .vtp .vti .vts .vtr .vtm .msh .mesh, and each of them with .gz;
        - is standard input
    output
        The mesh: .vtu .vtk .npz .msh .mesh hold the tetrahedra, .ply .stl the surface of the hull. In the
        plane all of them, .vtp and .obj hold the triangles. - is standard output
    choice
        What is run.
    picture
        Also draw a picture: .png .jpg, or .pdf .svg, which matplotlib paints
    delivery
        How the mesh is delivered.
    reporting
        What is said of it.
    """
    from ..plot import check_picture_path

    # what cannot end well does not start
    speaker = Speaker(reporting, aside=output == STREAM)
    formats = formats_of(delivery.format, source, output)
    if picture is not None:
        check_picture_path(picture)
        for other in {source, output} - {STREAM}:
            check_apart(picture, other)
    if not delivery.force and STREAM not in (source, output):
        check_apart(output, source, way_out="name another file, or say --force")
    job = _Job(choice, delivery, speaker, picture, source)
    with outgoing(output, formats.output) as (written, called):
        _checked(choice.check_output, written, called)
        names = ["reading", "triangulating", *["verifying"] * delivery.verify, "writing"]
        names += ["drawing"] * (picture is not None)
        with Steps(speaker.bars, names, quiet=reporting.quiet) as steps:
            result = job.run(steps, formats, written)
    speaker.say(f"wrote {called}" + (f" and {picture}" if picture is not None else ""))
    speaker.result({**result, "output": str(called), "picture": None if picture is None else str(picture)})


def _checked(check: Callable[[Path], object], path: Path, called: Path) -> None:
    """A check of a path that may be a copy's, whose errors have the name that the user knows."""
    from ..reading.guarded import guarded

    guarded(check, path, called)


@dataclass(frozen=True)
class _Job:
    """A triangulation from a file into a file."""

    choice: Choice
    delivery: Delivery
    speaker: Speaker
    picture: Path | None
    source: Path

    def run(self, steps: Steps, formats: Formats, output: Path) -> Mapping[str, object]:
        """Read, triangulate, verify, write and draw; what is reported to programs."""
        from .._carried import carried, said
        from .._mesh_plane import check_plane_path, draw_plane, write_plane_mesh
        from .._space_picture import draw_picture
        from ..files import check_mesh_path, write_mesh

        machine = self.choice.make_machine()
        with steps.step("reading"):
            cloud, called = self.read(formats.source)
        points = cloud.points
        self.speaker.say(f"{len(points):,} points from {called}")
        in_plane = points.shape[1] == 2
        check, write = (check_plane_path, write_plane_mesh) if in_plane else (check_mesh_path, write_mesh)
        check(output)
        data, left_out = carried(cloud.point_data, output.suffix)
        left_out = {**cloud.left_out, **left_out}
        tri = triangulated(self.speaker, steps, points, self.choice, machine)
        if self.delivery.verify:
            with steps.step("verifying"):
                self.check(tri)
        if left_out:  # an error before is one line, and this another
            logging.getLogger("dt3d").warning(said(left_out))
        with steps.step("writing"):
            write(tri, output, point_data=data, compress=self.delivery.compress)
        if self.picture is not None:
            with steps.step("drawing"):
                draw_plane(tri, self.picture) if in_plane else draw_picture(tri, self.picture)
        seconds = {name: spent for name, spent in steps.seconds.items() if name != "triangulating"}
        self.speaker.show(table_of(tri, one_line(called), details=self.delivery.details, files=seconds))
        if machine is not None and machine.ledger is not None:
            self.speaker.show(ledger_table(machine.ledger))
        return {
            "source": str(called),
            **result_of(tri, seconds),
            "point_data": list(data),
            "left_out": left_out,
            "verified": self.delivery.verify,
        }

    def read(self, extension: str) -> tuple[Cloud, Path]:
        """The points with their data, and what their file is called."""
        from ..files import read_cloud
        from ..reading.guarded import guarded

        with incoming(self.source, extension) as (path, called):
            cloud = guarded(lambda path: read_cloud(path, dimension=self.choice.dimension), path, called)
        self.choice.check_points(cloud.points, called)
        return cloud, called

    def check(self, tri: dt3d.Delaunay) -> None:
        """Say what is wrong, and end with the status of `dt3d verify`, if the result is not proved."""
        outcome = tri.verify()
        self.speaker.say("verified: " + ("a Delaunay triangulation" if outcome else "NOT one"))
        if not outcome:
            self.speaker.show(str(outcome))
            raise Verdict(NOT_DELAUNAY)


def triangulated(
    speaker: Speaker, steps: Steps, points: np.ndarray, choice: Choice, machine: sv.Machine | None = None
) -> dt3d.Delaunay:
    """The triangulation of points (n, 2) or (n, 3): a bar for insertion, a line for each iteration else."""
    in_space = points.shape[1] == 3
    inserts = machine is None and choice.robustness != "perturb" and choice.method != "extrapolation"
    with steps.step("triangulating", counts=in_space and inserts) as done:
        if not in_space:
            from .. import threaded2d

            method = cast("PlaneMethod", choice.method)  # checked with the points
            return threaded2d.Delaunay(points, method=method, threads=choice.threads, seed=choice.seed)

        def inserted(progress: dt3d.Progress) -> None:
            done(len(points) - progress.remaining, len(points))

        grows = None if speaker.how.silent else Growth(speaker.console)
        return dt3d.Delaunay(
            points,
            method=cast("Method", choice.method),
            robustness=choice.robustness,
            machine=machine,
            threads=choice.threads,
            dtype=choice.dtype,
            seed=choice.seed,
            callback=inserted if inserts else grows,
        )

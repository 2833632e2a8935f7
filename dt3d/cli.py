"""The command line: `dt3d demo`, `triangulate`, `verify`, `view`, `experiment`, `bench`.

Exit statuses: 0 done; 1 `dt3d verify` found no Delaunay triangulation; 2 bad words or input, or a file that
cannot be read or written, with one line that says what is wrong; 70 a fault of dt3d itself; 130 Ctrl-C; 141
whoever read the output has closed it.
"""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import cyclopts
from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape

import dt3d

from ._paths import check_apart, check_writable
from ._report import Growth, ledger_table, plane_table, stats_table
from ._status import NOT_DELAUNAY, Printer, Verdict, one_line, run

SPACE_METHODS = ("insertion", "extrapolation")

app = cyclopts.App(
    name="dt3d",
    help="3D Delaunay triangulation by parallel incremental extrapolation.\n\n"
    "Exit status: 0 done; 1 not a Delaunay triangulation (verify); 2 bad words, input or files; "
    "70 a fault of dt3d; 130 Ctrl-C; 141 the output was closed.",
    version=dt3d.__version__,
    suppress_keyboard_interrupt=False,
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    argv : sequence of str, optional
        The words after ``dt3d``; those of the process if left out.

    Returns
    -------
    int
        The exit status, as `dt3d._status` lists them.
    """

    def command(errors: Console) -> None:
        try:
            app(
                sys.argv[1:] if argv is None else list(argv),
                exit_on_error=False,
                print_error=False,
                console=Printer(),
                error_console=errors,
                result_action="return_value",
            )
        except cyclopts.CycloptsError as error:
            msg = f"{one_line(error)} (dt3d --help has the words)"
            raise ValueError(msg) from None

    return run(command)


@app.command
def demo(*, out: Path = Path("out")) -> None:
    """Triangulate a large protein complex that comes with the package; write mtor.vtu and mtor.png.

    Parameters
    ----------
    out
        The folder for both files; made if it is not there.
    """
    from .files import check_mesh_path, write_mesh
    from .plot import View, check_picture_path, draw
    from .samples import mtor

    out.mkdir(parents=True, exist_ok=True)
    check_mesh_path(out / "mtor.vtu")
    check_picture_path(out / "mtor.png")
    console = Printer(highlight=False)
    points = mtor()
    console.print(f"{len(points):,} atoms of two mTOR-mLST8 complexes (PDB entry 4JSV)")
    tri = _triangulate(console, points, method="extrapolation")
    console.print(stats_table(tri, "mTOR-mLST8, PDB entry 4JSV"))

    write_mesh(tri, out / "mtor.vtu")
    views = [
        View("all tetrahedra, cut open", shrink=0.85),
        View("those with edges up to 6 Å: the proteins", shrink=0.9, cut=False, longest=6.0),
    ]
    draw(tri, out / "mtor.png", views)
    _print(console, f"wrote {out / 'mtor.vtu'} (for dt3d view, ParaView, PyVista) and {out / 'mtor.png'}")


@app.command
def triangulate(
    source: Path,
    *,
    output: Annotated[Path, Parameter(alias="-o")],
    method: Literal[
        "auto",
        "insertion",
        "extrapolation",
        "sequential",
        "batch",
        "circumcircle",
        "pessimistic",
        "optimistic",
    ] = "auto",
    dimension: Literal[2, 3] | None = None,
    robustness: Literal["exact", "perturb"] = "exact",
    machine: Literal["device", "simulated"] | None = None,
    processors: int | None = None,
    threads: int | None = None,
    dtype: Literal["float64", "float32"] | None = None,
    seed: int = 0,
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
    method
        Insertion on this CPU, which is fast, or the paper's data-parallel extrapolation, which a machine or
        "perturb" asks for. Both find the same tetrahedra. In the plane: sequential, batch, circumcircle,
        pessimistic or optimistic, which find the same triangles.
    dimension
        2: in the plane, by x and y. 3: in space. If left out, as many coordinates as the points have.
    robustness
        Exact decisions, or the paper's perturbation and its count of inconsistencies.
    machine
        Where the vectors of an extrapolation live: on a device of JAX, or on simulated processors with a
        ledger of their steps.
    processors
        Number of simulated processors (32 if left out).
    threads
        At most so many threads insert; as many as there are cores if left out.
    dtype
        Precision of the perturbed search.
    seed
        Seed of the perturbation, and of the order of insertion in the plane.
    picture
        Also draw a picture: .png .pdf .svg .jpg
    force
        Let the mesh replace the very file that the points are read from. Other files are replaced anyway.
    """
    from ._mesh_plane import WRITERS as PLANE_WRITERS
    from ._mesh_plane import check_plane_path
    from .files import check_mesh_path, read_points, write_mesh
    from .plot import check_picture_path, draw

    # what cannot end well does not start
    in_space = {
        "method": method if method in SPACE_METHODS else None,
        "robustness": None if robustness == "exact" else robustness,
        "machine": machine,
        "processors": processors,
        "dtype": dtype,
    }
    only_in_space = [f"--{name} {value}" for name, value in in_space.items() if value is not None]
    only_in_plane = method not in ("auto", *SPACE_METHODS)
    if dimension == 2 or only_in_plane:
        check_plane_path(output)
    elif dimension == 3 or only_in_space or output.suffix.lower() not in PLANE_WRITERS:
        check_mesh_path(output)
    if picture is not None:
        check_picture_path(picture)
        check_apart(picture, output)
        check_apart(picture, source)
    if not force:
        check_apart(output, source, way_out="name another file, or say --force")
    on = _machine(machine, processors)

    console = Printer(highlight=False)
    points = read_points(source, dimension=dimension)
    if points.shape[1] == 2 and only_in_space:
        what = (
            "--dimension 2 asks"
            if dimension == 2
            else f"{one_line(source)} has two coordinates a point, which asks"
        )
        msg = f"{what} for a triangulation in the plane, and {only_in_space[0]} goes with points in space"
        raise ValueError(msg)
    if points.shape[1] == 3 and only_in_plane:
        msg = (
            f"--method {method} goes with points in the plane, and {one_line(source)} has three "
            "coordinates a point; say --dimension 2 to triangulate by x and y"
        )
        raise ValueError(msg)
    _print(console, f"{len(points):,} points from {source}")
    if points.shape[1] == 2:
        check_plane_path(output)
        _triangulate_plane(console, points, source, output, picture, method, threads, seed)
        return
    check_mesh_path(output)
    tri = _triangulate(
        console,
        points,
        method=method,
        robustness=robustness,
        machine=on,
        threads=threads,
        dtype=dtype,
        seed=seed,
    )
    console.print(stats_table(tri, one_line(source)))
    if on is not None and on.ledger is not None:
        console.print(ledger_table(on.ledger))
    write_mesh(tri, output)
    if picture is not None:
        draw(tri, picture)
    _print(console, f"wrote {output}" + (f" and {picture}" if picture is not None else ""))


@app.command
def verify(file: Path) -> None:
    """Prove with exact arithmetic that the tetrahedra of a mesh are a Delaunay triangulation of its points.

    Where a mesh has no tetrahedra, and triangles in the plane z = 0, those are proved. Prints a sentence for
    each invariant; the exit status is 1 if one is broken. Orientation breaks none.

    Parameters
    ----------
    file
        A mesh of tetrahedra, or of triangles in the plane, of either orientation: .vtu .vtk .npz .msh .mesh,
        and each of them with .gz
    """
    from ._mesh_plane import read_plane_mesh
    from .files import read_mesh

    outcome: Any
    if (plane := read_plane_mesh(file)) is not None:
        from .threaded2d import verify as check_plane

        outcome = check_plane(plane.points, plane.triangles)
    else:
        from .verification import verify as check

        mesh = read_mesh(file)
        outcome = check(mesh.points, mesh.simplices)
    verdict = "a Delaunay triangulation" if outcome else "NOT a Delaunay triangulation"
    console = Printer(highlight=False)
    console.print(str(outcome), markup=False, soft_wrap=True)
    console.print(f"{one_line(file)}: {verdict}", markup=False, soft_wrap=True)
    if not outcome:
        raise Verdict(NOT_DELAUNAY)


@app.command
def view(file: Path, *, screenshot: Path | None = None) -> None:
    """Show a mesh of tetrahedra in a window with a plane that cuts it open, or draw it into a file.

    Parameters
    ----------
    file
        A mesh of tetrahedra: .vtu .vtk .npz .msh .mesh, and each of them with .gz
    screenshot
        Draw into this file and open no window; works without a screen.
    """
    from ._mesh import show
    from .files import read_mesh
    from .plot import check_picture_path, draw

    if screenshot is not None:
        check_picture_path(screenshot)
        check_apart(screenshot, file)
    mesh = read_mesh(file)
    if screenshot is not None:
        draw(mesh, screenshot)
        _print(Printer(highlight=False), f"wrote {screenshot}")
        return
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        msg = "there is no screen to open a window on; use --screenshot FILE.png"
        raise ValueError(msg)
    show(mesh, title=str(file))


@app.command
def experiment(name: str | None = None, *, out: Path = Path("out"), **options: int | float | str) -> None:
    """Run an experiment of the papers; without a name, list them.

    Parameters
    ----------
    name
        One of the list.
    out
        The folder for its files; made if it is not there.
    options
        Options of the experiment itself.
    """
    from .experiments import EXPERIMENTS

    console = Printer(highlight=False)
    if name is None:
        for known, function in EXPERIMENTS.items():
            summary = " ".join((inspect.getdoc(function) or "").partition("\n\n")[0].split())
            console.print(f"{known:12s} {summary}", markup=False, soft_wrap=True)
        return
    if name not in EXPERIMENTS:
        msg = f"there is no experiment {name!r}; there are {', '.join(EXPERIMENTS)}"
        raise ValueError(msg)
    run: Any = EXPERIMENTS[name]
    options = {key.replace("-", "_"): value for key, value in options.items()}
    try:
        inspect.signature(run).bind(out, console, **options)
    except TypeError:
        takes = ", ".join(list(inspect.signature(run).parameters)[2:]) or "(none)"
        msg = f"experiment {name} takes the options {takes}; got {', '.join(options)}"
        raise ValueError(msg) from None
    out.mkdir(parents=True, exist_ok=True)
    check_writable(out / f"{name}.csv")
    run(out, console, **options)


@app.command
def bench(
    *,
    sizes: Annotated[list[float], Parameter(consume_multiple=True)] = [1e4, 1e5],  # noqa: B006
    distributions: Annotated[list[str], Parameter(consume_multiple=True)] = ["uniform"],  # noqa: B006
    file: Annotated[list[Path], Parameter(consume_multiple=True)] = [],  # noqa: B006
    against: Annotated[list[str] | None, Parameter(consume_multiple=True)] = None,
    threads: Annotated[list[int] | None, Parameter(consume_multiple=True)] = None,
    repeats: int = 5,
    limit: float = 60.0,
    verify: bool = False,
    out: Path = Path("out"),
) -> None:
    """Compare dt3d with SciPy and whatever else is installed; print a table, write bench.csv and bench.png.

    Each library runs in a process of its own that has warmed up; rounds over all of them are interleaved.
    Times are medians and leave out making and converting points. Memory is that of the first round.

    Parameters
    ----------
    sizes
        Numbers of sites: 1e4 1e5.
    distributions
        uniform gauss clusters sphere thin-sphere ball grid slab
    file
        Points of files, besides; without distributions, instead.
    against
        Some of: scipy vtk tetgen gmsh cgal. All that are installed if left out.
    threads
        Of dt3d: several numbers are compared, the others with the first.
    repeats
        Rounds.
    limit
        Seconds after which a run is ended, and after which a library gets no more rounds of a set.
    verify
        Prove the results by exact arithmetic, where a library shows its tetrahedra.
    out
        The folder for the files; made if it is not there.
    """
    from . import bench as benchmark

    for path in file:
        for written in benchmark.written(out):
            check_apart(written, path)
    # a table in a file need not be as narrow as a terminal
    console = Printer(highlight=False, width=None if sys.stdout.isatty() else 110)
    sets = [benchmark.generated(name, round(n)) for name in distributions for n in sizes]
    sets += [benchmark.from_file(path) for path in file]
    if against is None:
        against = [name for name, peer in benchmark.PEERS.items() if peer.installed]
        missing = [name for name in benchmark.PEERS if name not in against]
        if missing:
            console.print(f"not installed, so left out: {', '.join(missing)}", markup=False)
    limits = benchmark.Limits(repeats, limit)
    out.mkdir(parents=True, exist_ok=True)
    for written in benchmark.written(out):
        check_writable(written)
    measured = []
    for sites in sets:
        with console.status("") as status:

            def say(text: str, status: Any = status) -> None:
                status.update(escape(one_line(text)))

            measured += benchmark.compare(sites, against, threads or [None], limits, verify, say)
    benchmark.publish(measured, out, console)


def _print(console: Console, text: str) -> None:
    """A line with names of files, which may hold anything."""
    console.print(one_line(text), markup=False, soft_wrap=True)


def _triangulate(console: Console, points: Any, **options: Any) -> Any:
    inserts = options.get("machine") is None and options.get("robustness") != "perturb"
    left = "sites left" if inserts and options["method"] != "extrapolation" else "open faces"
    with console.status("triangulating (the first iteration includes compilation)"):
        return dt3d.Delaunay(points, callback=Growth(console, left), **options)


def _triangulate_plane(
    console: Console,
    points: Any,
    source: Path,
    output: Path,
    picture: Path | None,
    method: Any,
    threads: int | None,
    seed: int,
) -> None:
    from . import threaded2d
    from ._mesh_plane import draw_plane, write_plane_mesh

    with console.status("triangulating in the plane (the first time includes compilation)"):
        tri = threaded2d.Delaunay(points, method=method, threads=threads, seed=seed)
    console.print(plane_table(tri, one_line(source)))
    write_plane_mesh(tri, output)
    if picture is not None:
        draw_plane(tri, picture)
    _print(console, f"wrote {output}" + (f" and {picture}" if picture is not None else ""))


def _machine(machine: str | None, processors: int | None) -> Any:
    import scanvec

    if processors is not None and machine != "simulated":
        msg = "--processors goes with --machine simulated"
        raise ValueError(msg)
    if machine == "simulated":
        return scanvec.Simulated(processors=32 if processors is None else processors)
    return scanvec.Device() if machine == "device" else None


if __name__ == "__main__":
    from dt3d import _command

    sys.exit(_command.main())

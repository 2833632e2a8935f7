"""The command line: `dt3d demo`, `triangulate`, `verify`, `view`, `info`, `warmup` and more.

Exit statuses: 0 done; 1 `dt3d verify` found no Delaunay triangulation, or one of `experiment all` failed;
2 bad words or input, or a file that cannot be read or written, with one line that says what is wrong; 70 a
fault of dt3d itself; 130 Ctrl-C; 141 the reader of the output has closed it.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import cyclopts
from rich.console import Console

import dt3d

from .._status import Printer, one_line, run
from . import bench, compare, completion, demo, experiment, info, meshes, triangulate, warmup

__all__ = ["app", "main"]

app = cyclopts.App(
    name="dt3d",
    help="Exact Delaunay triangulations in space and in the plane, by multithreaded insertion or by the "
    "data-parallel algorithm of Teng et al.\n\n"
    "Exit status: 0 done; 1 not a Delaunay triangulation (verify), or one failed (experiment all); "
    "2 bad words, input or files; 70 a fault of dt3d; 130 Ctrl-C; 141 the output was closed.",
    help_format="plaintext",  # markdown takes longer to load than all else does
    version=dt3d.__version__,
    suppress_keyboard_interrupt=False,
)
for command in (
    demo.demo,
    triangulate.triangulate,
    meshes.verify,
    meshes.view,
    experiment.experiment,
    bench.bench,
    compare.compare,
    info.info,
    warmup.warmup,
    completion.completion,
):
    app.command(command)


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

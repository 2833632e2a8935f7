"""``dt3d bench``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from rich.markup import escape
from rich.status import Status

from .._paths import check_apart, check_writable
from .._status import Printer, one_line


@Parameter(name="*")
@dataclass(frozen=True)
class Rounds:
    """How often each library runs, and for how long.

    Attributes
    ----------
    repeats
        Rounds.
    limit
        Seconds after which a run is ended, and after which a library gets no more rounds of a set.
    verify
        Prove the results by exact arithmetic, where a library shows its tetrahedra.
    """

    repeats: int = 5
    limit: float = 60.0
    verify: bool = False


def bench(
    *,
    sizes: Annotated[list[float], Parameter(consume_multiple=True)] = [1e4, 1e5],  # noqa: B006
    distributions: Annotated[list[str], Parameter(consume_multiple=True)] = ["uniform"],  # noqa: B006
    file: Annotated[list[Path], Parameter(consume_multiple=True)] = [],  # noqa: B006
    against: Annotated[list[str] | None, Parameter(consume_multiple=True)] = None,
    threads: Annotated[list[int] | None, Parameter(consume_multiple=True)] = None,
    rounds: Rounds = Rounds(),
    out: Path = Path("out"),
) -> None:
    """Compare dt3d with SciPy and whatever else is installed; print a table, write bench.csv, .png and .pdf.

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
    rounds
        How often, and for how long.
    out
        The folder for the files; made if it is not there.
    """
    from .. import bench as benchmark

    for path in file:
        for written in benchmark.written(out):
            check_apart(written, path)
    console = Printer(highlight=False)
    sets = [benchmark.generated(name, round(n)) for name in distributions for n in sizes]
    sets += [benchmark.from_file(path) for path in file]
    if against is None:
        against = [name for name, peer in benchmark.PEERS.items() if peer.installed]
        missing = [name for name in benchmark.PEERS if name not in against]
        if missing:
            console.print(f"not installed, so left out: {', '.join(missing)}", markup=False)
    limits = benchmark.Limits(rounds.repeats, rounds.limit)
    out.mkdir(parents=True, exist_ok=True)
    for written in benchmark.written(out):
        check_writable(written)
    measured = []
    for sites in sets:
        with console.status("") as status:

            def say(text: str, status: Status = status) -> None:
                status.update(escape(one_line(text)))

            measured += benchmark.compare(sites, against, threads or [None], limits, rounds.verify, say)
    benchmark.publish(measured, out, console)

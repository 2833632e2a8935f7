"""``dt3d compare``."""

from __future__ import annotations

from pathlib import Path

from .._paths import check_writable
from .._status import Printer


def compare(
    name: str | None = None, *, rounds: int = 5, quick: bool = False, out: Path = Path("out")
) -> None:
    """Time what is made of triangulations beside other libraries; without a name, list the comparisons.

    Both sides run in turn, in one process, after a call that compiles. Ratios are of medians.

    Parameters
    ----------
    name
        One of the list, or "all".
    rounds
        How often each side runs.
    quick
        Small sizes, to see that everything runs; the numbers say little.
    out
        The folder for the tables; made if it is not there.
    """
    from ..bench import comparisons

    console = Printer(highlight=False)
    known = comparisons.COMPARISONS
    if name is None:
        width = max(map(len, known))
        for other, what in known.items():
            console.print(f"{other:{width}s} {what}", markup=False, soft_wrap=True)
        return
    if rounds < 1:
        msg = f"--rounds must be at least 1, got {rounds}"
        raise ValueError(msg)
    chosen = list(known) if name == "all" else [name]
    out.mkdir(parents=True, exist_ok=True)
    for each in chosen:
        check_writable(comparisons.file_of(out, each))
        comparisons.show(each, comparisons.measure(each, rounds, quick), out, console)

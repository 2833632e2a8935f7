"""``dt3d experiment``."""

from __future__ import annotations

import inspect
from pathlib import Path

from .._paths import check_writable
from .._status import Printer


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
    from ..experiments import EXPERIMENTS

    console = Printer(highlight=False)
    if name is None:
        for known, function in EXPERIMENTS.items():
            summary = " ".join((inspect.getdoc(function) or "").partition("\n\n")[0].split())
            console.print(f"{known:12s} {summary}", markup=False, soft_wrap=True)
        return
    if name not in EXPERIMENTS:
        msg = f"there is no experiment {name!r}; there are {', '.join(EXPERIMENTS)}"
        raise ValueError(msg)
    chosen = EXPERIMENTS[name]
    options = {key.replace("-", "_"): value for key, value in options.items()}
    try:
        inspect.signature(chosen).bind(out, console, **options)
    except TypeError:
        takes = ", ".join(list(inspect.signature(chosen).parameters)[2:]) or "(none)"
        msg = f"experiment {name} takes the options {takes}; got {', '.join(options)}"
        raise ValueError(msg) from None
    out.mkdir(parents=True, exist_ok=True)
    check_writable(out / f"{name}.csv")
    chosen(out, console, **options)

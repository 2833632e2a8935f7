"""``dt3d experiment``."""

from __future__ import annotations

import inspect
from pathlib import Path

from .._paths import check_writable
from .._status import EXPERIMENT_FAILED, Printer, Verdict
from .all_experiments import quick_options, run_all, summary_of

ALL = "all"


def experiment(
    name: str | None = None, *, out: Path = Path("out"), quick: bool = False, **options: int | float | str
) -> None:
    """Run an experiment of the papers, or all of them; without a name, list them.

    Parameters
    ----------
    name
        One of the list; or "all": each with its defaults, in order. One that fails does not stop the others;
        the exit status is 1 then.
    out
        The folder for its files; made if it is not there.
    quick
        Small sizes, to see that everything runs; the numbers say little.
    options
        Options of the experiment itself.
    """
    from ..experiments import EXPERIMENTS

    console = Printer(highlight=False)
    if name is None:
        width = max(map(len, EXPERIMENTS))
        for known, function in EXPERIMENTS.items():
            console.print(f"{known:{width}s} {summary_of(function)}", markup=False, soft_wrap=True)
        console.print(f"{ALL:{width}s} All of these, one after the other.", markup=False, soft_wrap=True)
        return
    if name == ALL:
        if set(options) - {"costs"}:
            msg = f"experiment all takes --out, --quick and --costs only; got {', '.join(options)}"
            raise ValueError(msg)
        out.mkdir(parents=True, exist_ok=True)
        for known in EXPERIMENTS:
            check_writable(out / f"{known}.csv")
        if any(ended.error for ended in run_all(EXPERIMENTS, out, console, quick=quick, options=options)):
            raise Verdict(EXPERIMENT_FAILED)
        return
    if name not in EXPERIMENTS:
        msg = f"there is no experiment {name!r}; there are {', '.join(EXPERIMENTS)}; or {ALL}"
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
    chosen(out, console, **(quick_options(chosen) if quick else {}) | options)

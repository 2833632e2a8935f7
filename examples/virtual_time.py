"""The methods of Kohout et al. 2004 on up to 64 processors that are not there: threads in virtual time.

Each processing element has a clock, and the one whose clock is least takes the next step of its thread: the
very step that real threads take, on the very triangles. What steps cost was measured once and ships with
dt3d, so the curves repeat. Look where each method ends: the pessimistic one at its critical section, the
batch method at what its one inserting thread can do, the circum-circle method where threads wait for each
other in circles; later if it tests fewer triangles, and one thread begins alone. Optimistic locks seldom
meet. Caches and the memory's bandwidth, which real processors share, are left out.

    python examples/virtual_time.py --sites 100000 --write out/virtual_time.png
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dt3d.experiments.kohout.costs import SHIPPED_NAME, chosen_costs
from dt3d.experiments.kohout.runs import PAPER, SpeedupSet, options_of

ELEMENTS = (1, 2, 4, 8, 16, 32, 64)
FEWER_TESTS = {**PAPER, "head_start": True, "tested": "outer"}
METHODS = {  # as published, but for the fourth
    "pessimistic": ("pessimistic", PAPER, "s-"),
    "batch": ("batch", PAPER, "^-"),
    "circum-circle": ("circumcircle", PAPER, "o-"),
    "circum-circle, fewer tests": ("circumcircle", FEWER_TESTS, "o--"),
    "optimistic": ("optimistic", PAPER, "D-"),
}


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Run threads in virtual time.")
    parser.add_argument("--sites", type=int, default=100_000)
    parser.add_argument("--write", type=Path, default=Path("out/virtual_time.png"))
    options = parser.parse_args(argv)

    sites = options.sites
    given = SpeedupSet("uniform", np.random.default_rng(0).random((sites, 2)), chosen_costs(SHIPPED_NAME))
    print(f"{sites:,} sites, by one thread: {given.alone:.3f} virtual seconds\n")
    print(f"{'':27}{'elements':>9}{'speed-up':>9}{'busy':>6}{'waits':>11}{'retries':>9}{'given up':>9}")
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    speed, waits = figure.subplots(1, 2)
    speed.plot(ELEMENTS, ELEMENTS, ":", color="0.6", label="as many times as elements")
    for name, (method, way, style) in METHODS.items():
        rows = []
        for elements in ELEMENTS:
            threads = max(4, elements) if method == "batch" else elements  # one of them inserts
            run = given.simulated(options_of(sites, method, threads, way), elements)
            rows.append((given.alone / run.seconds, run.waits / sites))
            counts = f"{run.busy:6.0%}{run.waits:11,}{run.retries:9,}{run.given_up:9,}"
            print(f"{name:27}{elements:9}{rows[-1][0]:9.2f}{counts}")
        gained, waited = np.array(rows).T
        (line,) = speed.plot(ELEMENTS, gained, style, label=name)
        waits.plot(ELEMENTS, np.where(waited > 0, waited, np.nan), style, color=line.get_color())
    for axes, title in ((speed, "speed-up over one thread"), (waits, "waits for each site")):
        axes.set(xscale="log", yscale="log", xlabel="processing elements", title=title)
        axes.set_xticks(ELEMENTS, map(str, ELEMENTS))
        axes.minorticks_off()
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    speed.set_yticks(ELEMENTS, map(str, ELEMENTS))
    speed.legend(frameon=False, fontsize=9)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(options.write, dpi=130)
    print(f"\nwrote {options.write}")


if __name__ == "__main__":
    main()

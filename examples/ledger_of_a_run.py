"""What a Connection Machine would have done: the ledger of one run of the method of Teng et al. 1993.

Every operation on vectors leaves an entry: its phase, its primitive, elements, and messages between nodes. A
model of the CM-5 makes seconds of them. Look at the top row: nearly all messages are questions (`get`), most
of them for sites in cells, but most seconds go into sends to the table in which equal faces meet. And at the
bottom: the last iterations find next to nothing, and still cost their steps.

    python examples/ledger_of_a_run.py --sites 1000 --nodes 32 --write out/ledger_of_a_run.png
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import dt3d
import scanvec as sv
import scanvec.plot

PRIMITIVES = {"map": "C0", "scan": "C1", "get": "C2", "send": "C3"}
COUNTS = {"steps": 1, "elements": 1e6, "messages": 1e6, "seconds": 1}


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Show the ledger of a triangulation on a CM-5.")
    parser.add_argument("--sites", type=int, default=1000)
    parser.add_argument("--nodes", type=int, default=32)
    parser.add_argument("--write", type=Path, default=Path("out/ledger_of_a_run.png"))
    options = parser.parse_args(argv)

    cm5 = sv.Simulated(processors=options.nodes, model=sv.CM5)
    points = np.random.default_rng(0).random((options.sites, 3))
    tri = dt3d.Delaunay(points, machine=cm5, preset="teng1993")
    ledger = cm5.ledger

    print(f"{len(tri.simplices):,} tetrahedra of {options.sites:,} sites; a CM-5 of {options.nodes} nodes:\n")
    print(f"{'':16}", *(f"{name:>12}" for name in COUNTS))
    for phase, row in ledger.by_phase().items():
        print(f"{phase:16} {row.steps:12,} {row.elements:12,} {row.messages:12,} {row.seconds:12.2f}")
    print(f"{'all':16} {ledger.steps:12,} {ledger.elements:12,} {ledger.messages:12,} {ledger.seconds:12.2f}")

    figure = Figure(figsize=(10, 6), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=(1, 1.1))
    phases = list(ledger.by_phase())[::-1]  # the first one on top
    panels = top.subplots(1, len(COUNTS), sharey=True)
    for axes, (name, unit) in zip(panels, COUNTS.items(), strict=True):
        left = np.zeros(len(phases))
        for primitive, color in PRIMITIVES.items():
            rows = {r.phase: r for r in ledger.table("phase", "primitive") if r.primitive == primitive}
            wide = np.array([getattr(rows[p], name) / unit if p in rows else 0 for p in phases])
            axes.barh(phases, wide, left=left, color=color, label=primitive)
            left += wide
        axes.set_title(name if unit == 1 else f"{name}, millions")
        axes.spines[["top", "right"]].set_visible(False)
    panels[2].legend(frameon=False, loc="lower right")

    by_iteration, by_node = bottom.subplots(1, 2)
    for axes in (by_iteration, by_node):
        axes.set_prop_cycle(color=["slategray", "goldenrod"])
    sv.plot.time_by_iteration(ledger, "face expansion", "dead faces", ax=by_iteration)
    found = ", ".join(f"{count:,}" for count in tri.stats.tetrahedra_per_iteration)
    by_iteration.set_title(f"tetrahedra found: {found}", fontsize=10)
    sv.plot.load_balance(ledger, "face expansion", ax=by_node)
    by_node.set_title("face expansion: the load of each node", fontsize=10)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(options.write, dpi=120)
    print(f"\nwrote {options.write}")


if __name__ == "__main__":
    main()

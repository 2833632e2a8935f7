"""How would this triangulation have run on Connection Machines of 32 to 1,024 nodes?

What to look at: the tetrahedra are found once, and the ledger counts what each machine's busiest node would
have had to do. With more nodes a node has fewer elements, in proportion; its messages become fewer more
slowly, and the steps, which cost the same however little there is to do, not at all. So the speed-up bends,
later for more sites: run it with 300 sites and with 3,000. The picture has the phases, and the speed-up.

    python examples/cm5_scaling.py --sites 1000 --folder out
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import dt3d
import scanvec as sv

NODES = (32, 64, 128, 256, 512, 1024)


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Predict a triangulation's time on CM-5s of many sizes.")
    parser.add_argument("--sites", type=int, default=1000)
    parser.add_argument("--folder", type=Path, default=Path("out"))
    options = parser.parse_args(argv)
    options.folder.mkdir(parents=True, exist_ok=True)

    points = np.random.default_rng(5).random((options.sites, 3))
    first, *more = NODES
    cm5 = sv.Simulated(first, model=sv.CM5, also=more)
    tri = dt3d.Delaunay(points, robustness="perturb", machine=cm5)
    print(f"{len(tri.simplices)} tetrahedra in {cm5.ledger.steps:,} steps")

    print(
        f"\n{'nodes':>6}{'seconds':>10}{'speed-up':>10}{'elements':>12}{'messages':>12} (the busiest node's)"
    )
    for nodes, ledger in cm5.ledgers.items():
        rows = ledger.by_phase().values()
        speedup = cm5.ledger.seconds / ledger.seconds
        elements, messages = sum(r.vp_steps for r in rows), sum(r.busiest for r in rows)
        print(f"{nodes:>6}{ledger.seconds:>10.2f}{speedup:>10.2f}{elements:>12,}{messages:>12,}")

    print(f"\non {first} nodes:")
    for phase, row in cm5.ledger.by_phase().items():
        print(f"  {phase:<16}{row.seconds:>8.2f} s{row.steps:>8,} steps")
    print(f"\n{sv.CM5}")

    figure = Figure(figsize=(9, 4), layout="constrained")
    bars, speed = figure.subplots(1, 2)
    names = [str(nodes) for nodes in NODES]
    below = np.zeros(len(NODES))
    for phase in cm5.ledger.by_phase():
        seconds = [ledger.by_phase()[phase].seconds for ledger in cm5.ledgers.values()]
        bars.bar(names, seconds, bottom=below, label=phase)
        speed.plot(NODES, seconds[0] / np.array(seconds), "o-", markersize=3)
        below += seconds
    speed.plot(NODES, below[0] / below, "ko-", linewidth=2, label="all phases")
    speed.plot(NODES, np.array(NODES) / first, ":", color="0.6", label="in proportion")
    speed.set(xscale="log", yscale="log", title=f"speed-up over {first} nodes", xlabel="nodes")
    speed.set_xticks(NODES, names)
    speed.set_yticks([1, 2, 4, 8, 16, 32], ["1", "2", "4", "8", "16", "32"])
    speed.minorticks_off()
    bars.set(title=f"predicted seconds, {options.sites:,} sites", xlabel="nodes")
    for axes in (bars, speed):
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False)
    path = options.folder / "cm5_scaling.png"
    figure.savefig(path, dpi=120)
    print(f"\nwrote {path}")


if __name__ == "__main__":
    main()

"""How would this triangulation have run on Connection Machines of 32 to 1,024 nodes?

What to look at: the tetrahedra are found once, and the ledger counts what each machine's busiest node would
have had to do. With more nodes a node has fewer elements, in proportion; its messages become fewer more
slowly, and the steps, which cost the same however little there is to do, not at all. So the speed-up bends,
later for more sites: run it with 300 sites and with 3,000. The picture shows in which phase the time goes.

    python examples/cm5_scaling.py --sites 1000 --folder out
"""

import argparse
from pathlib import Path

import numpy as np

import dt3d
import scanvec as sv
import scanvec.plot
from dt3d.plot import save_figure

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

    path = options.folder / "cm5_scaling.png"
    save_figure(sv.plot.time_by_primitive(cm5.ledger).figure, path)
    print(f"\nwrote {path}")


if __name__ == "__main__":
    main()

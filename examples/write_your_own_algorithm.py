"""A parallel algorithm of your own: the connected components of a graph, by random mating.

What to look at: the program has no loop over vertices or edges, only over rounds. In each round every
component tosses a coin; an edge between a head and a tail hooks the tail's component onto the head's, one of
several if there are more; then edges within a component are packed away. A component that has edges hooks
with a probability of a quarter at least, so O(log n) rounds are expected. The graph is a square
lattice of which half of the edges are open, by chance: as many as percolation needs. The picture has its
components.

The machine is simulated with a cost model, and each part of a round is a named phase, so that the ledger says
where the time goes. Under ``sv.EREW_PRAM`` the same ledger also lists the steps in which several elements
read or write one place: hooking is one, by intention. Put ``sv.Device()`` in place of the machine, and the
same functions run on one device.

    python examples/write_your_own_algorithm.py --write out/components.png

J. H. Reif, Optimal parallel algorithms for integer sorting and graph connectivity, TR-08-85, Harvard 1985.
"""

import argparse
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

import scanvec as sv
import scanvec.plot


def components(machine: sv.Machine, n: int, edges: np.ndarray, seed: int = 0) -> tuple[sv.Vector, int]:
    """The representative vertex of each vertex's component, and the rounds it took.

    Parameters
    ----------
    n : int
        The vertices are 0 .. n-1.
    edges : int array (m, 2)
    """
    rng = np.random.default_rng(seed)
    parent = machine.iota(n)
    u, v = (machine.vector(edges[:, k].astype(np.int32)) for k in (0, 1))
    rounds = 0
    while len(u):
        with machine.phase("hook"):
            heads = machine.vector(rng.random(n) < 0.5)
            head_u, head_v = sv.get(heads, u), sv.get(heads, v)
            # both directions of an edge may hook: the tail's component becomes a child of the head's
            parent = sv.send(u, v, sv.COPY, into=parent, where=head_u & ~head_v)
            parent = sv.send(v, u, sv.COPY, into=parent, where=head_v & ~head_u)
        with machine.phase("relabel"):
            u, v = sv.get(parent, u), sv.get(parent, v)
        with machine.phase("pack"):
            u, v = sv.pack((u, v), u != v)
        rounds += 1
    with machine.phase("find roots"):
        return roots(parent), rounds


def roots(parent: sv.Vector) -> sv.Vector:
    """The root of each vertex's tree, by pointer jumping: O(log depth) steps."""
    while True:
        further = sv.get(parent, parent)
        if not sv.reduce(further != parent, sv.OR):
            return parent
        parent = further


def count_components(root: sv.Vector) -> int:
    """How many vertices are their own root."""
    return int(sv.reduce(root.machine.map(_is_root, root, root.machine.iota(len(root))), sv.ADD))


def _is_root(root, vertex):
    return jnp.where(root == vertex, 1, 0)


def lattice(side: int, seed: int = 7) -> np.ndarray:
    """The open edges of a square lattice, int (m, 2): each with a probability of a half."""
    vertex = np.arange(side**2).reshape(side, side)
    right = np.stack([vertex[:, :-1], vertex[:, 1:]], axis=-1).reshape(-1, 2)
    up = np.stack([vertex[:-1], vertex[1:]], axis=-1).reshape(-1, 2)
    edges = np.concatenate([right, up])
    return edges[np.random.default_rng(seed).random(len(edges)) < 0.5]


def draw(side: int, edges: np.ndarray, root: np.ndarray, ledger: sv.Ledger, path: Path) -> None:
    """The components by their colours, the largest one red, and the seconds of each round."""
    figure = Figure(figsize=(10, 5), layout="constrained")
    graph, rounds = figure.subplots(1, 2)
    ends = np.stack([edges % side, edges // side], axis=-1)  # (m, 2, 2): vertex, coordinate
    size = np.bincount(root)
    shade = np.random.default_rng(0).uniform(0.1, 0.9, len(root))[root[edges[:, 0]]]
    largest = root[edges[:, 0]] == size.argmax()
    graph.add_collection(
        LineCollection(ends[~largest], array=shade[~largest], cmap="viridis", linewidths=1.2)
    )
    graph.add_collection(LineCollection(ends[largest], colors="crimson", linewidths=2))
    graph.autoscale_view()
    graph.set(
        aspect="equal", title=f"{np.count_nonzero(size):,} components, the largest of {size.max():,} vertices"
    )
    graph.set_axis_off()
    sv.plot.time_by_iteration(ledger, "hook", "relabel", "pack", ax=rounds)
    rounds.set(title="rounds of random mating", xlabel="round")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    print(f"\nwrote {path}")


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Find connected components by random mating.")
    parser.add_argument("--side", type=int, default=60, help="of the lattice, in vertices")
    parser.add_argument("--write", type=Path, help="a picture, by its extension")
    options = parser.parse_args(argv)
    n, edges = options.side**2, lattice(options.side)

    cm = sv.Simulated(processors=32, model=sv.CM5)
    root, rounds = components(cm, n, edges)
    print(f"{n} vertices, {len(edges)} edges: {count_components(root)} components after {rounds} rounds")

    print(f"\npredicted for a CM-5 of {cm.processors} nodes: {cm.ledger.seconds:.3f} s")
    for phase, row in cm.ledger.by_phase().items():
        time = f"{row.seconds:>8.3f} s{row.steps:>6} steps{row.messages:>10,} messages"
        print(f"  {phase or '(outside)':<12}{time}")
    print("by round, hook and relabel: ", end="")
    print(", ".join(f"{row.seconds:.3f} s" for row in cm.ledger.by_iteration("hook", "relabel")))

    # the same program and the same result on a machine that allows exclusive access only
    pram = sv.Simulated(processors=32, model=sv.EREW_PRAM)
    again, _ = components(pram, n, edges)
    assert np.array_equal(again.to_numpy(), root.to_numpy())
    conflicts = pram.ledger.conflicts
    print(f"\non an EREW PRAM {len(conflicts)} of {pram.ledger.steps} steps are not exclusive; the first:")
    print(f"  {conflicts[0]}")
    if options.write is not None:
        draw(options.side, edges, root.to_numpy(), cm.ledger, options.write)


if __name__ == "__main__":
    main()

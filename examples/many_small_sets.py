"""Thousands of small sets: by a loop, by threads, and by one call under `jax.vmap`, beside SciPy's loop.

A call of dt3d costs some tenths of a millisecond, however few the sites; SciPy's costs less. So SciPy's loop
is the fastest for the smallest sets, and dt3d for those of some hundred sites in space, of more in the plane.
Threads and `jax.vmap` take a set each, but gain little on two cores: the reason for `vmap` is a program of
JAX's around it. Look where the lines cross on your machine.

    python examples/many_small_sets.py --sets 2000 --write out/many_small_sets.png
"""

import argparse
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import jax
import numpy as np
import scipy.spatial
from matplotlib.figure import Figure

import dt3d
import dt3d.jax as dj

SIZES = (15, 60, 240, 960)  # sites of a set
ROUNDS = 3  # in turn; the least seconds of each way count


def by_loop(delaunay: type, sets: np.ndarray) -> int:
    return sum(len(delaunay(points).simplices) for points in sets)


def by_threads(sets: np.ndarray) -> int:
    with ThreadPoolExecutor() as pool:
        return sum(pool.map(lambda points: len(dt3d.Delaunay(points, threads=1).simplices), sets))


@jax.jit
def by_vmap(sets: jax.Array) -> jax.Array:
    return jax.vmap(dj.delaunay)(sets).count.sum()


WAYS = {
    "SciPy, a loop": partial(by_loop, scipy.spatial.Delaunay),
    "dt3d, a loop": partial(by_loop, dt3d.Delaunay),
    "dt3d, threads": by_threads,
    "dt3d, jax.vmap": lambda sets: int(by_vmap(sets)),
}


def milliseconds(sets: np.ndarray) -> dict[str, float]:
    """For a set, by each way; all of them find as many simplices."""
    seconds = {name: [] for name in WAYS}
    for _ in range(ROUNDS + 1):  # the first one compiles
        counts = set()
        for name, way in WAYS.items():
            begun = time.perf_counter()
            counts.add(way(sets))
            seconds[name].append(time.perf_counter() - begun)
        assert len(counts) == 1, counts
    return {name: 1e3 * min(taken[1:]) / len(sets) for name, taken in seconds.items()}


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Time many small triangulations.")
    parser.add_argument(
        "--sets", type=int, default=2000, help="of 60 sites; fewer if larger, more if smaller"
    )
    parser.add_argument("--write", type=Path, default=Path("out/many_small_sets.png"))
    options = parser.parse_args(argv)

    figure = Figure(figsize=(8, 3.8), layout="constrained")
    for axes, d in zip(figure.subplots(1, 2, sharey=True), (2, 3), strict=True):
        where = "in the plane" if d == 2 else "in space"
        print(f"milliseconds for a set {where}\n{'sets':>6}{'sites':>6}", *(f"{name:>15}" for name in WAYS))
        rows = []
        for size in SIZES:
            count = max(2, options.sets * 60 // size)
            sets = np.random.default_rng(0).random((count, size, d), np.float32)
            rows.append(milliseconds(sets))
            print(f"{count:6,}{size:6}", *(f"{took:15.3f}" for took in rows[-1].values()))
        print()
        for name, color, style in zip(
            WAYS, ("tab:gray", "C0", "C1", "C3"), ("s--", "o-", "^-", "D-"), strict=True
        ):
            axes.loglog(SIZES, [row[name] for row in rows], style, color=color, label=name)
        axes.set(title=where, xlabel="sites of a set", xticks=SIZES, xticklabels=SIZES)
        axes.minorticks_off()
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    figure.axes[0].set_ylabel("milliseconds for a set")
    figure.axes[0].legend(frameon=False)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(options.write, dpi=150)
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

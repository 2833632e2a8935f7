"""Three classics of the scan model: line of sight, split radix sort, quicksort.

What to look at: none of the three has a loop over elements. Each line is one operation on whole vectors, and
the work that a serial program does with loops and recursion is done by scans: a max-scan remembers the
steepest slope so far, a plus-scan says where each element goes, a segmented scan runs all recursive calls of
quicksort at once. The program runs on 32 simulated processors; the tables at the end say how many steps each
algorithm took, and how many messages crossed between processors. Put ``sv.Device()`` in place of the
machine, and the same functions run on one device.

    python examples/scan_primitives.py --write out/scan_primitives.png

G. E. Blelloch, Vector Models for Data-Parallel Computing, MIT Press 1990, chapter 3.
"""

import argparse
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

import scanvec as sv


def line_of_sight(altitude: sv.Vector) -> sv.Vector:
    """Which points of a ray the observer sees, who stands at its first point.

    A point is visible if it appears steeper than every point before it. The observer's own point is not.
    """
    cm = altitude.machine
    slope = cm.map(_slope, altitude, cm.iota(len(altitude)), cm.item(altitude, 0))
    return slope > sv.scan(slope, sv.MAX)


def _slope(altitude, distance, observer):
    return jnp.where(distance == 0, -jnp.inf, (altitude - observer) / jnp.maximum(distance, 1))


def split_radix_sort(keys: sv.Vector, bits: int) -> sv.Vector:
    """The keys, integers in 0 .. 2^bits - 1, in ascending order.

    One split a bit, least significant first; as each is stable, the order of the bits below survives it.
    """
    for k in range(bits):
        keys = sv.split(keys, keys.machine.map(_bit, keys, k))
    return keys


def _bit(key, k):
    return (key >> k) & 1 == 1


def quicksort(keys: sv.Vector) -> tuple[sv.Vector, int]:
    """The keys in ascending order, and the rounds that this took.

    A segment is one recursive call. In each round every segment splits at its first key into three: those
    less than it, equal to it, and greater; O(log n) rounds are expected when the keys come in random order.
    """
    cm, rounds = keys.machine, 0
    segments = sv.Segments.from_flags(cm.full(len(keys), False, bool))
    while not _is_sorted(keys):
        pivot = sv.copy_scan(keys, segments)
        less, equal, greater = keys < pivot, keys == pivot, keys > pivot

        # where each key goes: past the start of its segment, the groups before its own, and those of its
        # own group that stand to its left
        number_less, number_equal = (
            sv.get(sv.reduce(group, sv.ADD, segments), segments.ids) for group in (less, equal)
        )
        left = tuple(sv.enumerate(group, segments) for group in (less, equal, greater))
        start = sv.get(segments.starts, segments.ids)
        target = cm.map(_target, less, equal, left, number_less, number_equal) + start

        # each group becomes a segment
        keys, group = sv.permute((keys, cm.map(_group, less, equal)), target)
        segments = sv.Segments.from_flags((group != _previous(group)) | segments.heads)
        rounds += 1
    return keys, rounds


def _target(less, equal, left, number_less, number_equal):
    among_rest = jnp.where(equal, number_less + left[1], number_less + number_equal + left[2])
    return jnp.where(less, left[0], among_rest)


def _group(less, equal):
    return jnp.where(less, 0, jnp.where(equal, 1, 2))


def _previous(v: sv.Vector) -> sv.Vector:
    index = v.machine.iota(len(v))
    return sv.get(v, index - 1, where=index > 0, otherwise=0)


def _is_sorted(keys: sv.Vector) -> bool:
    ordered = (_previous(keys) <= keys) | (keys.machine.iota(len(keys)) == 0)
    return bool(sv.reduce(ordered, sv.AND))


def draw(altitude: np.ndarray, visible: np.ndarray, machine: sv.Machine, path: Path) -> None:
    """What the observer sees, and the way of 64 keys through the splits of the radix sort."""
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    view, sorting = figure.subplots(1, 2)
    view.fill_between(np.arange(len(altitude)), altitude.min() - 50, altitude, color="0.8", linewidth=0)
    for k in visible:
        view.plot([0, k], altitude[[0, k]], color="gold", linewidth=0.3, zorder=0)
    view.plot(visible, altitude[visible], ".", color="crimson", markersize=3, label="visible")
    view.plot(0, altitude[0], "k^", label="observer", clip_on=False)
    view.set(title="line of sight: a max-scan", xlabel="distance", ylabel="altitude")
    view.margins(0)
    view.legend(frameon=False, loc="upper left")

    keys = machine.vector(np.random.default_rng(2).permutation(64))
    places = np.array([np.argsort(split_radix_sort(keys, k).to_numpy()) for k in range(7)])
    for key, place in enumerate(places.T):
        sorting.plot(place, range(7), color=colormaps["viridis"](key / 63), linewidth=1.2)
    sorting.set(
        title="split radix sort of 64 keys: a split for each bit", xlabel="place", ylabel="bits so far"
    )
    sorting.invert_yaxis()
    sorting.margins(0.01)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    print(f"\nwrote {path}")


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Run three classics of the scan model.")
    parser.add_argument("--write", type=Path, help="a picture, by its extension")
    options = parser.parse_args(argv)

    cm = sv.Simulated(processors=32)
    rng = np.random.default_rng(1990)
    hills = (
        np.cumsum(np.convolve(rng.normal(0, 1, 1000), np.ones(25) / 5, "same")) + np.arange(1000) ** 2 / 3e3
    )
    altitude, keys = cm.vector(hills), cm.vector(rng.integers(0, 2**10, 1000))

    with cm.phase("line of sight"):
        visible = sv.pack_index(line_of_sight(altitude))
    with cm.phase("radix sort"):
        by_bits = split_radix_sort(keys, bits=10)
    with cm.phase("quicksort"):
        by_pivots, rounds = quicksort(keys)

    print(f"line of sight: of {len(altitude)} points {len(visible)} are visible")
    print(f"split radix sort: {by_bits.to_numpy()[:8].tolist()} ..., 10 splits")
    print(f"quicksort: {by_pivots.to_numpy()[:8].tolist()} ..., {rounds} rounds")
    print(f"\n{'on 32 processors':<16}{'steps':>8}{'VP steps':>10}{'messages':>10}")
    for row in cm.ledger.table("phase"):
        print(f"{row.phase:<16}{row.steps:>8}{row.vp_steps:>10}{row.messages:>10}")
    print(f"\n{cm.ledger}")
    if options.write is not None:
        draw(hills, visible.to_numpy(), cm, options.write)


if __name__ == "__main__":
    main()

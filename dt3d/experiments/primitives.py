"""Step and element complexity of each primitive, measured against its formula: not in the paper.

The names are those of G. E. Blelloch, Vector Models for Data-Parallel Computing, MIT Press 1990, chapters 3
and 4, beside scanvec's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import scanvec as sv

from ._output import new_table, panels, publish

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

PROCESSORS = 32
SIZES = tuple(2**k for k in range(4, 17, 3))


class Inputs(NamedTuple):
    """Vectors of length n on one machine, whose ledger starts empty."""

    v: sv.Vector  # int32, random
    flags: sv.Vector  # every third
    order: sv.Vector  # a random permutation
    counts: sv.Vector  # 0, 1, 2, 0, ...; they add up to about n
    segments: sv.Segments  # of four elements
    clear: sv.Vector  # those whose flag is clear, and those whose flag is set
    set: sv.Vector


Elements = Callable[[int, int], tuple[int, int]]


@dataclass(frozen=True)
class Primitive:
    """An operation: its names, a call, and what it is said to take.

    Attributes
    ----------
    name, blelloch : str
        scanvec's name and the book's.
    steps : (bits) -> int
        Step complexity, where ``bits`` of the keys differ (it matters to sorts only).
    elements : (n, steps) -> (int, int)
        Least and greatest element complexity.
    """

    name: str
    blelloch: str
    call: Callable[[Inputs], object]
    steps: Callable[[int], int]
    elements: Elements


def _each_step_all(n: int, steps: int) -> tuple[int, int]:
    return n * steps, n * steps


def _at_most_all(n: int, steps: int) -> tuple[int, int]:
    return n, n * steps


def _up_to_twice(n: int, steps: int) -> tuple[int, int]:
    return n, 2 * n * steps


def _make(
    name: str,
    blelloch: str,
    call: Callable[[Inputs], object],
    steps: int,
    elements: Elements = _each_step_all,
) -> Primitive:
    return Primitive(name, blelloch, call, lambda bits: steps, elements)


CATALOGUE = (
    _make("v + w", "p-+, p-<, ...", lambda x: x.v + x.order, 1),
    _make("where", "p-select", lambda x: sv.where(x.flags, x.v, x.order), 1),
    _make("map(where=)", "-", lambda x: x.v.machine.map(abs, x.v, where=x.flags, otherwise=0), 1),
    _make("iota", "index", lambda x: x.v.machine.iota(len(x.v)), 1),
    _make("permute", "permute", lambda x: sv.permute(x.v, x.order), 1),
    _make("get", "concurrent read", lambda x: sv.get(x.v, x.order), 1),
    _make("send", "concurrent write", lambda x: sv.send(x.v, x.order, sv.ADD, into=x.v), 1),
    _make("scan(ADD)", "+-scan", lambda x: sv.scan(x.v, sv.ADD), 1),
    _make("scan(MAX)", "max-scan", lambda x: sv.scan(x.v, sv.MAX), 1),
    _make("scan(segments)", "seg-+-scan", lambda x: sv.scan(x.v, sv.ADD, x.segments), 1),
    _make("backscan", "back-+-scan", lambda x: sv.backscan(x.v, sv.ADD), 1),
    _make("copy_scan", "copy, seg-copy", lambda x: sv.copy_scan(x.v, x.segments), 1),
    _make("enumerate", "enumerate", lambda x: sv.enumerate(x.flags), 2),
    _make("reduce", "+-reduce", lambda x: sv.reduce(x.v, sv.ADD), 1),
    _make("reduce(segments)", "seg-+-reduce", lambda x: sv.reduce(x.v, sv.ADD, x.segments), 5, _at_most_all),
    _make("op_distribute", "+-distribute", lambda x: sv.op_distribute(x.v, sv.ADD), 2),
    _make("pack", "pack", lambda x: sv.pack(x.v, x.flags), 4),
    _make("pack_index", "pack of index", lambda x: sv.pack_index(x.flags), 5),
    _make("split", "split", lambda x: sv.split(x.v, x.flags), 5),
    _make("split(segments)", "seg-split", lambda x: sv.split(x.v, x.flags, x.segments), 7),
    _make("flag_merge", "flag-merge", lambda x: sv.flag_merge(x.clear, x.set, x.flags), 7),
    _make("insert", "insert", lambda x: sv.insert(x.v, 0, 1), 1),
    _make("append", "append", lambda x: sv.append(x.v, x.v), 5, _up_to_twice),
    _make("distribute", "distribute, allocate", lambda x: sv.distribute(x.v, x.counts), 12, _up_to_twice),
    Primitive("rank", "rank", lambda x: sv.rank(x.v), lambda bits: 7 + 6 * bits, _each_step_all),
    Primitive("sort", "split-radix-sort", lambda x: sv.sort(x.v), lambda bits: 6 + 6 * bits, _each_step_all),
)


@dataclass(frozen=True)
class Measurement:
    """One operation over n elements, on ``PROCESSORS`` processors."""

    primitive: Primitive
    n: int
    bits: int
    row: sv.Row

    @property
    def stated_steps(self) -> int:
        """The steps that the formula says."""
        return self.primitive.steps(self.bits)

    @property
    def holds(self) -> bool:
        """Whether the counted steps and elements are those stated."""
        least, most = self.primitive.elements(self.n, self.stated_steps)
        return self.row.steps == self.stated_steps and least <= self.row.elements <= most


def measurements(sizes: tuple[int, ...] = SIZES) -> Iterator[Measurement]:
    """Every operation over vectors of every size."""
    rng = np.random.default_rng(0)
    for n in sizes:
        cm = sv.Simulated(PROCESSORS, model=sv.SCAN)
        values = rng.integers(0, 16, n).astype(np.int32)
        values[:2] = 0, 15
        flags = np.arange(n) % 3 == 1
        inputs = Inputs(
            cm.vector(values),
            cm.vector(flags),
            cm.vector(rng.permutation(n).astype(np.int32)),
            cm.vector((np.arange(n) % 3).astype(np.int32)),
            sv.Segments.from_lengths(cm.full(n // 4, 4, np.int32)),
            cm.vector(values[~flags]),
            cm.vector(values[flags]),
        )
        differ = int(np.bitwise_or.reduce(values ^ values[0])).bit_count()
        for primitive in CATALOGUE:
            cm.ledger.entries.clear()
            with cm.operation(primitive.name):
                primitive.call(inputs)
            (row,) = cm.ledger.table("operation")
            yield Measurement(primitive, n, differ, row)


def primitives(out: Path, console: Console) -> list[Measurement]:
    """Not in the papers: steps and elements of each scan-vector primitive, counted, against its formula.

    Writes ``primitives.csv``, ``primitives.png`` and ``primitives.pdf`` into ``out``.
    """
    out.mkdir(parents=True, exist_ok=True)
    with console.status("..."):
        found = list(measurements())
    largest = SIZES[-1]
    table = new_table(
        f"Steps and elements of {largest:,} elements on {PROCESSORS} processors",
        ("scanvec", "Blelloch 1990"),
        ("steps: stated / counted", "elements / n", "VP steps / step", "holds"),
    )
    for m in found:
        if m.n == largest:
            table.add_row(
                m.primitive.name,
                m.primitive.blelloch,
                f"{m.stated_steps} / {m.row.steps}",
                f"{m.row.elements / m.n:.2f}",
                f"{m.row.vp_steps / m.row.steps:.0f}",
                "yes" if all(o.holds for o in found if o.primitive is m.primitive) else "no",
            )
    table.show(console)
    console.print(
        f"It holds if the steps are those stated, and the elements within the stated bounds, at all of "
        f"{', '.join(f'{n:,}' for n in SIZES)} elements. With {PROCESSORS} processors a step over n elements "
        f"takes ceil(n / {PROCESSORS}) VP steps: {largest // PROCESSORS:,} at {largest:,}."
    )
    counted = ("steps", "elements", "vp_steps", "messages")
    lines = [
        (
            m.primitive.name,
            m.primitive.blelloch,
            m.n,
            m.stated_steps,
            *(getattr(m.row, c) for c in counted),
            m.holds,
        )
        for m in found
    ]
    publish(
        console,
        out,
        "primitives",
        ["scanvec", "blelloch", "n", "stated_steps", *counted, "holds"],
        lines,
        _draw(found),
    )
    return found


def _draw(found: list[Measurement]) -> Figure:
    """A row for each operation: its steps, stated and counted, and its elements over n at every size."""
    figure, (left, right) = panels(2, 4.5)
    figure.set_figheight(1 + 0.21 * len(CATALOGUE))
    largest = [m for m in found if m.n == SIZES[-1]]
    row = {m.primitive.name: k for k, m in enumerate(largest)}
    left.barh(list(row.values()), [m.row.steps for m in largest], color="tab:blue", label="counted")
    left.plot([m.stated_steps for m in largest], list(row.values()), "k|", ms=9, mew=2, label="stated")
    for n, colour in zip(SIZES, ("0.8", "0.6", "0.4", "0.2", "tab:orange"), strict=True):
        own = [m for m in found if m.n == n]
        x, y = [m.row.elements / n for m in own], [row[m.primitive.name] for m in own]
        right.plot(x, y, "o", ms=9 - 1.4 * SIZES.index(n), color=colour, label=f"n = {n:,}")
    left.set(xlabel=f"steps, n = {SIZES[-1]:,}", ylabel="operation", xscale="log", xlim=(0.8, None))
    right.set(xlabel="elements / n", xscale="log", xlim=(0.8, None))
    for ax, names in ((left, list(row)), (right, [])):
        ax.set_yticks(range(len(names)) if names else [], names, fontsize=8)
        ax.set_ylim(len(row) - 0.5, -0.5)
        ax.grid(axis="x", color="0.9")
        ax.set_axisbelow(True)
        ax.set_xticks([1, 2, 5, 10, 20, 50], ["1", "2", "5", "10", "20", "50"])
        ax.minorticks_off()
        ax.legend(fontsize=8, loc="upper right")
    return figure

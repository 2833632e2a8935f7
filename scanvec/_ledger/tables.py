"""A ledger's entries added up by a key, as text, and as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import fields
from pathlib import Path

from .._models.model import Model
from .._writing import written_aside
from .entry import Entry, Row

KEYS = ("phase", "operation", "primitive")


def groups(entries: Iterable[Entry], by: Sequence[str]) -> dict[tuple[str, ...], list[Entry]]:
    """The entries by their values of `KEYS`, in order of first appearance; empty for keys not asked for.

    Raises ValueError for another key.
    """
    for key in by:
        if key not in KEYS:
            msg = f"cannot group the ledger by {key!r}; use {', '.join(KEYS)}"
            raise ValueError(msg)
    out: dict[tuple[str, ...], list[Entry]] = {}
    for e in entries:
        out.setdefault(tuple(getattr(e, k) if k in by else "" for k in KEYS), []).append(e)
    return out


def add_up(key: Sequence[str], entries: list[Entry], model: Model | None, processors: int) -> Row:
    """One row: the sums of these entries, and their seconds where there is a model."""
    phase, operation, primitive = key
    return Row(
        phase=phase,
        operation=operation,
        primitive=primitive,
        steps=len(entries),
        elements=sum(e.elements for e in entries),
        vp_steps=sum(e.vp_ratio for e in entries),
        max_vp_ratio=max(e.vp_ratio for e in entries),
        messages=sum(e.messages for e in entries),
        busiest=sum(e.busiest for e in entries),
        seconds=None if model is None else sum(model.seconds(e, processors) for e in entries),
    )


def write_csv(path: Path, entries: Iterable[Entry], model: Model | None, processors: int) -> None:
    """One line a step: the attributes of `Entry`, and predicted seconds where there is a model."""
    names = [f.name for f in fields(Entry)]
    with written_aside(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([*names, *(["seconds"] if model else [])])
        for e in entries:
            values: list[object] = [getattr(e, n) for n in names]
            if model is not None:
                values.append(model.seconds(e, processors))
            writer.writerow(values)


def as_text(rows: Sequence[Row], seconds: bool) -> str:
    """Aligned columns under their names, without the phase."""
    names = [f.name for f in fields(Row) if f.name != "phase" and (seconds or f.name != "seconds")]
    lines = [names, *([_text(getattr(r, n)) for n in names] for r in rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join("  ".join(x.rjust(w) for x, w in zip(line, widths, strict=True)) for line in lines)


def _text(value: object) -> str:
    return f"{value:.6f}" if isinstance(value, float) else str(value)

"""Tables on the screen and in a pipe, of which nothing is cut.

rich fits a table into the screen by cutting cells short ("1.…") or by folding numbers. Here a table that is
too wide for a terminal is split into blocks of columns, each of which begins with the first ones again; in a
pipe or a file lines are as long as they must be.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from rich.box import SIMPLE
from rich.console import Console, ConsoleOptions, RenderableType
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text


class Sheet:
    """A table of texts: columns of numbers to the right, names to the left.

    Parameters
    ----------
    title : str
        A line above it.
    columns : sequence of str
        The headers.
    left : collection of str
        The headers of those columns that hold texts.
    keep : int
        So many columns come again in each block of a table that is split.
    """

    def __init__(
        self, title: str, columns: Sequence[str], left: Collection[str] = (), *, keep: int = 1
    ) -> None:
        self.title, self.columns, self.left, self.keep = title, list(columns), set(left), keep
        self.rows: list[list[str]] = []
        self.sections: set[int] = set()  # numbers of the rows that a line follows

    @property
    def row_count(self) -> int:
        """The number of rows."""
        return len(self.rows)

    def add_row(self, *cells: str) -> None:
        """A row; a ValueError if it has not a cell for each column."""
        if len(cells) != len(self.columns):
            msg = f"the table has {len(self.columns)} columns, got {len(cells)} cells"
            raise ValueError(msg)
        self.rows.append(list(cells))

    def add_section(self) -> None:
        """A line below the last row."""
        self.sections.add(len(self.rows) - 1)

    def show(self, console: Console) -> None:
        """Print it: at a terminal within the width of the screen, elsewhere in one piece."""
        width = console.width if console.is_terminal else None
        for part in self._parts(console, console.options, width):
            console.print(part, soft_wrap=True)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[RenderableType]:
        """What ``console.print(sheet)`` prints: blocks within the width, as rich crops what is wider."""
        yield from self._parts(console, options, options.max_width)

    def _parts(
        self, console: Console, options: ConsoleOptions, width: int | None
    ) -> Iterator[RenderableType]:
        yield Text(self.title, style="italic")
        first, rest = list(range(self.keep)), list(range(self.keep, len(self.columns)))
        while True:
            taken = len(rest)
            while width is not None and taken > 1 and self._width(console, first + rest[:taken]) > width:
                taken -= 1
            chosen = first + rest[:taken]
            table = self._table(chosen)
            table.width = self._width(console, chosen)
            yield table
            rest = rest[taken:]
            if not rest:
                return

    def _width(self, console: Console, chosen: list[int]) -> int:
        """The columns of the screen that these columns take."""
        return Measurement.get(console, console.options.update(width=1_000_000), self._table(chosen)).maximum

    def _table(self, chosen: list[int]) -> Table:
        table = Table(box=SIMPLE)
        for k in chosen:
            justify = "left" if self.columns[k] in self.left else "right"
            table.add_column(Text(self.columns[k]), justify=justify, no_wrap=True)  # type: ignore[arg-type]
        for number, row in enumerate(self.rows):
            table.add_row(*(Text(row[k]) for k in chosen), end_section=number in self.sections)
        return table

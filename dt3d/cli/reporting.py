"""What a command says, and where: for people, for programs, or nothing."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field

from cyclopts import Parameter
from rich.console import Console, RenderableType

from .._status import Printer
from .report import say


@Parameter(name="*", group="What is said", negative=())
@dataclass(frozen=True)
class Reporting:
    """How a command reports.

    Attributes
    ----------
    quiet
        Say nothing; errors and warnings still come, on standard error.
    json
        Print the result as one line of JSON, and nothing else.
    """

    quiet: bool = field(default=False)
    json: bool = field(default=False)

    @property
    def silent(self) -> bool:
        """Whether nothing is to be said to people."""
        return self.quiet or self.json


class Speaker:
    """Says what a command has to say, as it is asked to.

    Parameters
    ----------
    how : Reporting
        What was asked for.
    aside : bool
        Speak on standard error, since standard output is taken.

    Raises
    ------
    ValueError
        If JSON is asked for, and standard output is taken.
    """

    def __init__(self, how: Reporting, *, aside: bool = False) -> None:
        if how.json and aside:
            msg = "--json prints to standard output, where -o - writes the mesh; name a file for the mesh"
            raise ValueError(msg)
        self.how = how
        self.console = Printer(stderr=aside, highlight=False)

    @property
    def bars(self) -> Console:
        """Where bars are drawn: beside the words if these go to a terminal, and else on standard error."""
        return self.console if self.console.is_terminal else Printer(stderr=True, highlight=False)

    def say(self, text: str) -> None:
        """Print a line with names of files, which may hold anything."""
        if not self.how.silent:
            say(self.console, text)

    def show(self, what: RenderableType) -> None:
        """Print a table."""
        if not self.how.silent:
            self.console.print(what)

    def result(self, found: Mapping[str, object]) -> None:
        """Print the result for programs, if it was asked for."""
        if self.how.json:
            self.console.print(json.dumps(found), markup=False, soft_wrap=True)

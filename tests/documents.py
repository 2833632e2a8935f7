"""Pages as tests see them: the programs of a page, which run, and the rows of its tables."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]


def page(name: str) -> str:
    """The text of a page, by its path below the root."""
    return (ROOT / name).read_text(encoding="utf-8")


def programs(text: str) -> list[str]:
    """The Python programs of a page."""
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


def sessions(text: str) -> str:
    """What is typed at a prompt on a page, and what comes back, as doctest has it."""
    return "\n".join(re.findall(r"```pycon\n(.*?)```", text, re.DOTALL))


def run(programs: list[str], **names: object) -> dict[str, object]:
    """Run programs one after the other in one namespace, which may have names at first; it is returned."""
    assert programs
    for number, program in enumerate(programs, 1):
        exec(compile(program, f"program {number} of the page", "exec"), names)
    return names


def rows(text: str, header: str) -> list[list[str]]:
    """The cells of the table below a header line, which is given as it stands."""
    _, found, rest = text.partition(f"{header}\n")
    assert found, f"no table under {header}"
    lines = rest.partition("\n\n")[0].splitlines()[1:]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def links(text: str) -> list[str]:
    """The files that a page links to, without those of other sites."""
    return [target for target in re.findall(r"\]\(([^)#]+)\)", text) if "://" not in target]

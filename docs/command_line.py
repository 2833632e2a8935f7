"""The directive `dt3d`: what a command line of dt3d prints, run while the page is made.

Its argument is what stands after ``dt3d``, such as ``triangulate --help``.
"""

from __future__ import annotations

import os
import subprocess
import sys

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class CommandLine(SphinxDirective):
    """The words after `dt3d` are the argument; the block shows them, and what is printed."""

    required_arguments = 0
    optional_arguments = 1
    final_argument_whitespace = True

    def run(self) -> list[nodes.Node]:
        """The block."""
        words = self.arguments[0].split() if self.arguments else []
        # as wide as a page; a pipe has no width of its own
        surroundings = os.environ | {"COLUMNS": "96", "NO_COLOR": "1", "TERM": "dumb"}
        command = [sys.executable, "-m", "dt3d", *words]
        done = subprocess.run(command, capture_output=True, text=True, env=surroundings, check=False)
        if done.returncode:
            msg = f"dt3d {' '.join(words)} ended with {done.returncode}: {done.stderr}"
            raise self.error(msg)
        text = "\n".join(line.rstrip() for line in done.stdout.splitlines()).strip("\n")
        shown = f"$ {' '.join(['dt3d', *words])}\n{text}"
        return [nodes.literal_block(shown, shown, language="none")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("dt3d", CommandLine)
    return {"parallel_read_safe": True}

"""Code in cells of tables may break before a dot and behind a bracket or slash: wide tables then fit a page.

By ``<wbr>``, which a browser does not copy with the text.
"""

from __future__ import annotations

import re
from html import escape

from docutils import nodes
from sphinx.application import Sphinx

LONG = 24  # shorter code stays in one piece
BREAK = re.compile(r"(?<=[\w)\]])(?=\.(?!py\b)[A-Za-z_])|(?<=\()(?=[^)])|(?<=/)(?=\w)")


def allow(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Put the breaks into long code of tables."""
    if app.builder.format != "html":
        return
    for cell in doctree.findall(nodes.entry):
        for code in list(cell.findall(nodes.literal)):
            text = code.astext()
            if len(text) > LONG:
                html = f'<code class="docutils literal">{BREAK.sub("<wbr>", escape(text))}</code>'
                code.replace_self(nodes.raw("", html, format="html"))


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect it; links within code are resolved before."""
    app.connect("doctree-resolved", allow, priority=900)
    return {"parallel_read_safe": True}

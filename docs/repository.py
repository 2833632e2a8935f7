"""Links to files of the repository that are no pages: programs, as pages that show them.

In Markdown a link to a file becomes a download. A program is read rather than kept, so each that a page links
to gets a page with its text, in colours, below ``source/``.
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any, cast

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.builders.html import StandaloneHTMLBuilder

LANGUAGES = {".py": "python", ".cff": "yaml"}


def mark(app: Sphinx, doctree: nodes.document) -> None:
    """Turn downloads into references, whose address is known when pages are written."""
    for node in list(doctree.findall(addnodes.download_reference)):
        path, _ = app.env.relfn2path(node["reftarget"], app.env.docname)
        if Path(path).suffix in LANGUAGES:
            node.replace_self(nodes.reference("", "", *node.children, internal=True, repository_file=path))


def address(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Give these references their address, and note the files."""
    for node in doctree.findall(nodes.reference):
        path = node.get("repository_file")
        if path:
            node["refuri"] = app.builder.get_relative_uri(docname, f"source/{path}")
            shown(app).add(path)


def pages(app: Sphinx) -> Iterator[tuple[str, dict[str, Any], str]]:
    """A page for each file that is linked to."""
    highlighter = cast("StandaloneHTMLBuilder", app.builder).highlighter
    for path in sorted(shown(app)):
        text = (Path(app.srcdir) / path).read_text(encoding="utf-8")
        code = highlighter.highlight_block(text, LANGUAGES[Path(path).suffix])
        yield f"source/{path}", {"title": path, "body": f"<h1>{escape(path)}</h1>{code}"}, "page.html"


def shown(app: Sphinx) -> set[str]:
    """The files that pages link to."""
    if not hasattr(app, "repository_files"):
        app.repository_files = set()  # type: ignore[attr-defined]
    return cast("set[str]", app.repository_files)  # type: ignore[attr-defined]


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect these; `mark` goes before Sphinx collects downloads."""
    app.connect("doctree-read", mark, priority=100)
    app.connect("doctree-resolved", address)
    app.connect("html-collect-pages", pages)
    return {"parallel_read_safe": True}

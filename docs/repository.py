"""Links between files of the repository: a folder leads to its README."""

from __future__ import annotations

from sphinx.application import Sphinx


def setup(app: Sphinx) -> dict[str, bool]:
    """Nothing yet."""
    return {"parallel_read_safe": True}

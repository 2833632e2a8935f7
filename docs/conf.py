"""How Sphinx makes the site: `make docs` runs it, without a network.

The source folder is the root of the repository. So the READMEs, ARCHITECTURE.md and CHANGELOG.md are read where
they stand, each is a page, and the links and pictures in them work on the site as they do in the repository.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]
os.environ.setdefault("PYVISTA_OFF_SCREEN", "true")

import dt3d  # noqa: E402  the path comes first

project = "dt3d and scanvec"
author = "the dt3d developers"
copyright = author
version = release = dt3d.__version__

extensions = [
    "myst_parser",  # pages in Markdown
    "sphinx.ext.autodoc",  # API pages from docstrings
    "numpydoc",  # whose sections are NumPy's
    "command_line",  # what the commands say of themselves; beside this file
    "repository",  # links to files that are no pages; beside this file
]

root_doc = "docs/index"
include_patterns = ["*.md", "docs/**.md", "examples/README.md", "scanvec/**/README.md", "dt3d/**/README.md"]
include_patterns += ["scanvec/README.md", "dt3d/README.md"]
exclude_patterns = [".*", "docs/_build", "build", "dist", "out", "**/__pycache__"]
source_suffix = {".md": "markdown"}

# -- text

myst_enable_extensions: list[str] = []
default_role = "py:obj"
highlight_language = "none"  # blocks without a name are commands and drawings

# -- API

autodoc_typehints = "none"  # docstrings say shapes and dtypes, which types do not
autodoc_member_order = "bysource"
numpydoc_show_class_members = False  # autodoc lists them, where a page asks for them
numpydoc_validation_checks: set[str] = set()

nitpicky = True

suppress_warnings = [
    "myst.header",  # README has a part of the third level before the first of the second
]

# -- the pages in HTML

html_theme = "pydata_sphinx_theme"
html_title = "dt3d and scanvec"
html_show_sourcelink = False
html_copy_source = False
html_additional_pages = {"index": "redirect.html"}  # the first page is docs/index.html
templates_path = ["_templates"]
html_theme_options = {
    "navbar_align": "left",
    "show_prev_next": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "navigation_with_keys": False,
}

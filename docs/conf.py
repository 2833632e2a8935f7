"""How Sphinx makes the site: `make docs` runs it, without a network.

The source folder is the root of the repository. So the READMEs, ARCHITECTURE.md and CHANGELOG.md are read
where they stand, each is a page, and their links and pictures work as they do in the repository.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]  # this checkout, and the extensions beside this file

import dt3d  # noqa: E402  the path comes first

project = "dt3d and scanvec"
author = "the dt3d developers"
copyright = author
version = release = dt3d.__version__

extensions = [
    "myst_parser",  # pages in Markdown
    "sphinx.ext.autodoc",  # API pages from docstrings
    "numpydoc",  # whose sections are NumPy's
    # in this folder
    "breaks",  # wide tables of code
    "command_line",  # what the commands say of themselves
    "repository",  # links to files that are no pages
]

root_doc = "docs/index"
# what is read: folders of programs and of what was built are not walked through
include_patterns = ["*.md", "docs/**.md", "**/README.md"]
exclude_patterns = [".*", "docs/_build", "build", "dist", "out", "**/__pycache__"]
source_suffix = {".md": "markdown"}

# -- text

default_role = "py:obj"  # single backticks in docstrings are names, and links
highlight_language = "none"  # blocks without a name are commands and drawings

# -- API

autodoc_typehints = "none"  # docstrings say shapes and dtypes, which types do not
autodoc_member_order = "bysource"
numpydoc_show_class_members = False  # autodoc lists them, where a page asks for them
autosummary_generate = False  # numpydoc brings it; there are no pages to generate

nitpicky = True
nitpick_ignore_regex = [
    # other packages: their sites would have to be fetched for links
    (r"py:.*", r"(scipy|jax|meshio)\..*"),
]
nitpick_ignore = [
    # fields, which the section Attributes of their class lists; they have no entry of their own
    ("py:obj", "Mesh.count"),
    ("py:obj", "Mesh.status"),
    ("py:obj", "cost"),
    ("py:obj", "face_expansions"),
    ("py:obj", "identity"),
    ("py:obj", "ledger"),
    ("py:obj", "points"),
    ("py:obj", "waves"),
    # of dt3d.Delaunay, whose members threaded2d.Delaunay has without a list of its own
    ("py:obj", "duplicates"),
    ("py:obj", "subset"),
]

suppress_warnings = [
    "myst.header",  # README has a part of the third level before the first of the second
]

# -- the pages in HTML

html_theme = "pydata_sphinx_theme"
html_title = "dt3d and scanvec"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_additional_pages = {"index": "redirect.html"}  # the first page is docs/index.html
html_sidebars = {page: [] for page in ["CHANGELOG", "docs/first_steps", "examples/README", "source/**"]}
toc_object_entries_show_parents = "hide"
templates_path = ["_templates"]
html_theme_options = {
    "navbar_align": "left",
    "show_prev_next": False,
    "show_toc_level": 2,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "navigation_with_keys": False,
}

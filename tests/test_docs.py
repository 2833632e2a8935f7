"""The site is built without a warning; it has every public name, no dead link, and nothing from a network."""

from __future__ import annotations

import importlib
import inspect
import re
import subprocess
import sys
from dataclasses import dataclass, field
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest

import dt3d
from dt3d._extrapolation_options import ExtrapolationOptions
from dt3d.cli import app
from dt3d.experiments import EXPERIMENTS
from dt3d.threaded2d.options import PlaneOptions

from .documents import ROOT, page

PACKAGES = [
    "dt3d",
    "dt3d.files",
    "dt3d.interpolate",
    "dt3d.jax",
    "dt3d.predicates",
    "dt3d.threaded2d",
    "dt3d.verification",
    "scanvec",
]

WORDS = ["-b", "html", "-c", "docs", "-W", "--keep-going", "-q"]

CLASSES = [
    "Delaunay",
    "Subset",
    "Voronoi",
    "interpolate.Linear",
    "interpolate.NaturalNeighbor",
    "interpolate.Nearest",
]

# attributes by which a browser loads something, and what it needs not to follow by itself
LOADED = {("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("link", "href")}


@dataclass
class Page(HTMLParser):
    """What a page defines, links to and loads."""

    path: Path
    ids: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    loaded: list[str] = field(default_factory=list)
    inline: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self.text = self.path.read_text(encoding="utf-8")
        self.within = ""
        self.feed(self.text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.within = tag
        for name, value in attrs:
            if name == "id":
                self.ids.add(value or "")
            elif (tag, name) in LOADED and value:
                self.loaded.append(value)
            elif name == "href" and value:
                self.links.append(value)

    def handle_data(self, data: str) -> None:
        if self.within in ("script", "style"):
            self.inline.append(data)

    def handle_endtag(self, tag: str) -> None:
        self.within = ""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, as `make docs` makes it."""
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *WORDS, "-d", folder / "doctrees", ".", folder / "html"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "WARNING" not in done.stderr
    return folder / "html"


@pytest.fixture(scope="module")
def pages(site):
    found = [Page(path) for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
    assert len(found) > 40
    return {one.path.relative_to(site).as_posix(): one for one in found}


def test_make_docs_builds_what_is_tested():
    (line,) = re.findall(r"-m sphinx (.*)", page("Makefile"))
    assert line.split() == [*WORDS, ".", "docs/_build/html"]


def test_every_page_of_the_repository_is_on_the_site(pages):
    folders = ("docs", "dt3d", "scanvec", "examples")
    names = [
        path.relative_to(ROOT)
        for folder in folders
        for path in (ROOT / folder).rglob("*.md")
        if "_build" not in path.parts
    ]
    names += [Path(name) for name in ("README.md", "ARCHITECTURE.md", "CHANGELOG.md")]
    assert len(names) > 20
    assert not [name for name in names if name.with_suffix(".html").as_posix() not in pages]


def test_docstrings_and_pages_have_no_errors(pages):
    errors = re.compile('class="(system-message|problematic)')
    assert not [name for name, one in pages.items() if errors.search(one.text)]
    # "J. Kohout" at the beginning of a paragraph would become item 10 of a list
    assert not [name for name, one in pages.items() if re.search(r'<ol class="(upper|lower)', one.text)]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_is_on_an_api_page(package, pages):
    shown = _signatures(pages)
    names = importlib.import_module(package).__all__
    assert names
    assert not [name for name in names if f"{package}.{name}" not in shown]


@pytest.mark.parametrize("name", CLASSES)
def test_every_member_is_on_an_api_page(name, pages):
    ids = set().union(*(one.ids for path, one in pages.items() if path.startswith("docs/api/")))
    assert not [member for member in _members(name) if f"dt3d.{name}.{member}" not in ids]


@pytest.mark.parametrize("name", CLASSES)
def test_every_member_has_an_example(name):
    members = _members(name)
    assert len(members) > 1
    assert not [member for member, documented in members.items() if ">>>" not in (documented.__doc__ or "")]


def test_lines_in_tables_are_whole_though_they_may_break(pages):
    shown = unescape(re.sub(r"<[^>]*>", "", pages["docs/one_line.html"].text))
    lines = re.findall(r"\| `([^`]+)` \|", page("docs/one_line.md"))
    assert len(lines) > 30
    assert not [line for line in lines if line not in shown]
    assert "<wbr>.vertex_neighbor_vertices" in pages["docs/one_line.html"].text


def test_programs_are_pages_with_all_of_their_text(pages):
    linked = {name for name in pages if name.startswith("source/examples/")}
    programs = [path.name for path in (ROOT / "examples").glob("*.py")]
    assert linked == {f"source/examples/{name}.html" for name in programs}
    shown = unescape(re.sub(r"<[^>]*>", "", pages["source/examples/from_scipy.py.html"].text))
    assert page("examples/from_scipy.py").strip() in shown


def test_commands_and_experiments_are_on_their_page(pages):
    text = pages["docs/api/command_line.html"].text
    commands = [name for name in app if not name.startswith("-")]
    assert len(commands) > 8
    assert not [name for name in commands if f"$ dt3d {name} --help\nUsage: dt3d {name}" not in text]
    assert not [name for name in EXPERIMENTS if not re.search(rf"^{name} +\w", text, re.MULTILINE)]


def test_links_lead_to_pages_and_places(pages, site):
    wrong = []
    for name, one in pages.items():
        for link in one.links + one.loaded:
            target, _, place = link.partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            path = (one.path.parent / unquote(target.partition("?")[0])).resolve() if target else one.path
            if not path.is_file():
                wrong.append(f"{name}: {link}")
                continue
            other = pages.get(path.relative_to(site).as_posix())
            if place and other and unquote(place) not in other.ids:
                wrong.append(f"{name}: {link}, no such place")
    assert not wrong, "\n".join(wrong)


def test_nothing_is_loaded_from_a_network(pages, site):
    assert any(one.loaded for one in pages.values())
    remote = [
        f"{name}: {address}"
        for name, one in pages.items()
        for address in one.loaded
        if re.match(r"([a-z]+:)?//", address)
    ]
    remote += [
        f"{name}: {text.strip()[:80]}"
        for name, one in pages.items()
        for text in one.inline
        if re.search(r"(import|fetch|src|url)\W{0,4}https?://", text)
    ]
    for path in site.rglob("*.css"):
        text = path.read_text(encoding="utf-8")
        remote += [
            f"{path.name}: {found}"
            for found in re.findall(r"(?:url\(|@import)\s*['\"]?(?:https?:)?//[^)'\"]*", text)
        ]
    assert not remote, "\n".join(remote)


def test_what_a_page_loads_is_found(tmp_path):
    bad = tmp_path / "bad.html"
    bad.write_text(
        '<link rel="stylesheet" href="https://a.b/c.css"><script src="//d.e/f.js"></script><p id="g">'
        '<a href="h.html#i">j</a><style>@import url(https://k.l)</style>'
    )
    one = Page(bad)
    assert one.loaded == ["https://a.b/c.css", "//d.e/f.js"]
    assert (one.ids, one.links, one.inline) == ({"g"}, ["h.html#i"], ["@import url(https://k.l)"])


def test_the_page_of_the_papers_has_every_experiment_and_option():
    text = page("docs/from_the_papers.md")
    named = set(re.findall(r"`(?:dt3d experiment )?([\w-]+)`", text))
    assert not set(EXPERIMENTS) - named
    commands = set(re.findall(r"`dt3d experiment ([\w-]+)`", text))
    assert commands <= set(EXPERIMENTS)
    plane = set(inspect.signature(dt3d.threaded2d.Delaunay).parameters) | set(PlaneOptions.__annotations__)
    first_cells = re.findall(r"^\| [^|]*\| `(\w+)[`=]", text, re.MULTILINE)
    space = set(ExtrapolationOptions.__annotations__) | {"machine", "robustness", "dtype"}
    assert len(first_cells) > 15
    assert not set(first_cells) - plane - space - {"dt3d", "tri"}


def _members(name: str) -> dict[str, object]:
    """The public methods and properties of a class of dt3d; annotated fields are not among them."""
    module, _, last = f"dt3d.{name}".rpartition(".")
    cls = getattr(importlib.import_module(module), last)
    return {m: inspect.getattr_static(cls, m) for m in dir(cls) if not m.startswith("_")} | {
        m: inspect.getattr_static(cls, m) for m in ("__call__",) if "interpolate" in name
    }


def _signatures(pages: dict[str, Page]) -> set[str]:
    """The full names of all that the API pages document."""
    found = set()
    for path, one in pages.items():
        if path.startswith("docs/api/"):
            for text in re.findall(r'<dt class="sig[^"]*"[^>]*>(.*?)</dt>', one.text, re.DOTALL):
                plain = re.sub(r"<[^>]*>", "", text)
                found |= set(re.findall(r"(?:dt3d|scanvec)[\w.]*", plain)[:1])
    return found

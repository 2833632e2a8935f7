"""What the pages say is so: programs run, links lead to files, sections of papers are where it is said."""

from __future__ import annotations

import ast
import doctest
import re

import pytest

import dt3d
import scanvec as sv

from .documents import ROOT, links, page, programs, rows, run, sessions

PAGES = sorted(
    path.relative_to(ROOT).as_posix()
    for path in ROOT.rglob("*.md")
    if not any(part.startswith(".") for part in path.relative_to(ROOT).parts)
)

# those that are written for the site; the others it shows as they are
SITE = [name for name in PAGES if name.startswith("docs/")]

PROGRAMS = {name: programs(page(name)) for name in SITE if programs(page(name))}

PAPERS = ("Teng et al. 1993", "Kohout et al. 2004")


FEWER = [program.replace("random((2000, 3))", "random((150, 3))") for program in programs(page("README.md"))]


def test_what_is_typed_in_the_readme():
    found = doctest.DocTestParser().get_doctest(sessions(page("README.md")), {}, "README.md", None, 0)
    assert len(found.examples) > 5
    assert doctest.DocTestRunner().run(found).failed == 0


def test_the_programs_of_the_readme(tmp_path, monkeypatch):
    """Each alone; those that are done in seconds. `test_all_programs_of_the_readme` has the others, too."""
    monkeypatch.chdir(tmp_path)
    quick = [program for program in FEWER if "machine=" not in program]
    assert len(quick) == len(FEWER) - 1
    found = [run([program]) for program in quick]
    assert len(found[0]["points"]) == 150
    # what the comments beside the lines say
    (names,) = (names for names in found if "copies" in names)
    v = names["v"]
    assert sv.scan(v, sv.ADD).to_numpy().tolist() == [0, 5, 6, 9, 13, 16, 25, 27]
    assert sv.pack(v, v > 3).to_numpy().tolist() == [5, 4, 9, 6]
    sums = sv.reduce(names["copies"], sv.ADD, names["segments"])
    assert sums.to_numpy().tolist() == [25, 1, 9, 16, 9, 81, 4, 36]


def test_what_is_typed_on_the_pages_of_the_site():
    typed = {name: sessions(page(name)) for name in SITE if sessions(page(name))}
    assert len(typed) >= 3
    for name, text in typed.items():
        found = doctest.DocTestParser().get_doctest(text, {}, name, None, 0)
        assert found.examples
        assert doctest.DocTestRunner().run(found).failed == 0, name


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_of_the_site(name, tmp_path, monkeypatch):
    """Each alone; those that are done in seconds."""
    monkeypatch.chdir(tmp_path)
    for program in PROGRAMS[name]:
        if "machine=" not in program:
            run([program])


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in PROGRAMS if "machine=" in page(name)])
def test_all_programs_of_the_site(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for program in PROGRAMS[name]:
        run([program])


@pytest.mark.slow
def test_all_programs_of_the_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = [run([program]) for program in FEWER]
    (names,) = (names for names in found if "cm5" in names and "tri" in names)
    ledger = names["cm5"].ledger
    assert len((tmp_path / "steps.csv").read_text().splitlines()) == ledger.steps + 1
    assert names["cm5"].ledgers[256].seconds < ledger.seconds
    assert len(names["tri"].simplices) == len(dt3d.Delaunay(names["points"]).simplices)
    assert "face expansion" in {row.phase for row in ledger.table("phase")}


@pytest.mark.parametrize("name", PAGES)
def test_links_lead_to_files(name):
    missing = [link for link in links(page(name)) if not (ROOT / name).parent.joinpath(link).exists()]
    assert not missing


def test_all_examples_are_listed():
    examples = {path.name for path in (ROOT / "examples").glob("*.py")}
    assert set(re.findall(r"^\| \[(\w+\.py)\]", page("examples/README.md"), re.MULTILINE)) == examples


@pytest.mark.parametrize("paper", PAPERS)
def test_a_section_of_a_paper_is_in_one_file_that_says_so(paper):
    table = rows(page("ARCHITECTURE.md"), f"| {paper} | file |")
    sections = [section for section, _ in table]
    assert len(set(sections)) == len(sections) > 8
    wrong = []
    for section, cell in table:
        (file,) = re.findall(r"`([^`]+)`", cell)
        path = ROOT / (file if file.startswith("scanvec/") else f"dt3d/{file}")
        if not path.is_file():
            wrong.append(f"{file} does not exist")
            continue
        docstring = " ".join((ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").split())
        if not _names(docstring, section):
            wrong.append(f"the docstring of {file} does not name section {section}")
    assert not wrong, "\n".join(wrong)


def test_how_a_docstring_names_a_section():
    assert _names("Teng et al. 1993, section 4.2: cells.", "4.2 cells")
    assert _names("Teng et al. 1993, sections 3 and 4.2.", "4.2 cells")
    assert _names("Algorithm 2 of Kohout et al. 2004.", "Algorithm 2: the batch method")
    assert not _names("Teng et al. 1993, section 4: cells.", "4.2 cells")
    assert not _names("Teng et al. 1993, section 14.2.", "4.2 cells")
    assert not _names("Algorithm 3 of Kohout et al. 2004.", "Algorithm 2: the batch method")


def test_links_and_rows():
    text = "a [b](c.py), [d](https://e.f/g.py)\n"
    text += "\n| h | i |\n|---|---|\n| j | k \\| l |\n| m | n |\n\n| o | p |\n"
    assert links(text) == ["c.py"]
    assert rows(text, "| h | i |") == [["j", "k \\| l"], ["m", "n"]]


def _names(docstring: str, section: str) -> bool:
    """Whether a docstring names the section with which a row begins: 4.2 or Algorithm 2, then some words."""
    name = re.match(r"[\d.]+|[A-Z]\w+ (\d|[A-Z]\w+( [A-Z]\w+)*)", section)
    assert name, f"no section: {section}"
    if name[0][0].isdigit():
        return (
            re.search(rf"\bsections? ([\d.]+(, | and ))*{re.escape(name[0])}(?![\d]|\.\d)", docstring)
            is not None
        )
    return re.search(rf"\b{name[0]}\b", docstring) is not None

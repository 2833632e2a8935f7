"""What to cite."""

from pathlib import Path

import dt3d

ROOT = Path(__file__).parents[2]


def test_references_print_a_line_each():
    found = dt3d.references()
    lines = repr(found).splitlines()
    assert len(lines) == len(found) > 5
    for line, reference in zip(lines, found, strict=True):
        assert line.startswith(reference.authors)
        assert line.endswith(f"Here: {reference.used_for}.")


def test_the_citation_file_has_the_version_and_both_papers():
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {dt3d.__version__}\n" in text
    for reference in dt3d.references()[:2]:
        assert reference.title in text

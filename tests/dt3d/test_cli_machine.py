"""`dt3d info`, `warmup` and `completion`: what concerns a machine and not a set of points."""

import importlib.metadata
import json
import os
import subprocess
import sys

import pytest

import dt3d
from dt3d import _warmup, cli
from dt3d.cli import warmup
from dt3d.predicates import lexicographic


def test_info_says_what_is_installed(capsys, monkeypatch):
    found = importlib.metadata.version
    absent = importlib.metadata.PackageNotFoundError

    def version(name):
        if name == "gemmi":
            raise absent
        return found(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    assert cli.main(["info"]) == 0
    out = capsys.readouterr().out
    assert f" {dt3d.__version__} in " in out
    assert f" {found('numba')} " in out
    assert "not installed: pip install 'dt3d[formats]'" in out
    assert cli.main(["info", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["packages"]["gemmi"] is None
    assert report["packages"]["numpy"] == found("numpy")
    assert report["cores"] >= 1


def test_info_counts_what_is_compiled(tmp_path):
    def report():
        words = [sys.executable, "-m", "dt3d", "info", "--json"]
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    assert (report()["compiled_functions"], report()["cache"]) == (0, str(tmp_path))
    code = "from dt3d.geometry.depths import depths; import numpy; depths(numpy.full((1, 4), -1))"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
    assert report()["compiled_functions"] == 1


def test_info_where_nothing_can_be_kept(monkeypatch, capsys):
    monkeypatch.setattr(lexicographic, "before", lambda: None)
    assert cli.main(["info", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["compiled_functions"] == 0
    assert "set the environment variable NUMBA_CACHE_DIR" in report["cache"]


def test_warmup_calls_all_of_it(monkeypatch, capsys):
    """Each in a process of its own; what is on disk already makes it short."""
    monkeypatch.setattr(_warmup, "OTHERS", (_warmup.proofs, _warmup.queries))
    assert cli.main(["warmup"]) == 0
    out = capsys.readouterr().out
    names = [line.split("s  ")[1] for line in out.splitlines()[:-1]]
    assert names[0] == "triangulations in space"
    assert sorted(names[1:]) == ["proofs", "queries"]
    assert out.splitlines()[-1].endswith("in all; what was compiled is on disk")


@pytest.mark.slow
@pytest.mark.parametrize("task", [_warmup.FIRST, *_warmup.OTHERS])
def test_every_part_of_it_runs(task):
    task()


def test_what_cannot_be_compiled_is_said(monkeypatch, capsys):
    monkeypatch.setattr(warmup, "PROGRAM", "{path}; raise SystemExit('no compiler')  # {function}")
    assert cli.main(["warmup"]) == 2
    assert capsys.readouterr().err == "dt3d: triangulations in space could not be compiled: no compiler\n"


def test_bash_completes_words(capsys):
    assert cli.main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    lines = [script, "complete -p dt3d", "COMP_WORDS=(dt3d tri)", "COMP_CWORD=1", "_dt3d"]
    lines.append('echo "${COMPREPLY[@]}"')
    done = subprocess.run(["bash", "-c", "\n".join(lines)], capture_output=True, text=True, check=True)
    assert "dt3d" in done.stdout.splitlines()[0]
    assert "triangulate" in done.stdout.splitlines()[-1]
    for shell in ("zsh", "fish"):
        assert cli.main(["completion", shell]) == 0
        assert "triangulate" in capsys.readouterr().out

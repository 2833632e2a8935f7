"""What a first call says that has to compile."""

import logging
import re
import subprocess
import sys
from pathlib import Path

import dt3d
from dt3d._numba import announce
from dt3d._numba.announce import OTHER, PARTS, part_of
from dt3d._numba.kept import Kept

COMPILE = """
import numba
from dt3d._numba.announce import announce_compilation

def seldom(x):
    return x + 1

def compiled(module):
    seldom.__module__ = module
    return numba.njit(seldom)

announce_compilation()
announce_compilation()
compiled("elsewhere")(1)
print("now")
compiled("dt3d.insertion.somewhere")(1)
compiled("dt3d.insertion.elsewhere")(1)
compiled("dt3d.threaded2d.verification")(1)
"""


def test_each_part_is_announced_once_and_only_where_it_is_ours():
    done = subprocess.run([sys.executable, "-c", COMPILE], capture_output=True, text=True, check=True)
    assert done.stdout == "now\n"
    first, second = done.stderr.splitlines()
    assert re.match(r"compiling insertion in space, some \d+ s, once on this machine", first)
    assert re.match(r"compiling proofs, some \d+ s, once", second)


def test_a_folder_that_cannot_be_written_is_said(monkeypatch, caplog):
    monkeypatch.setattr(Kept, "anywhere", False)
    monkeypatch.setattr(announce, "_said", lambda said=set(): said)
    with caplog.at_level(logging.WARNING, "dt3d"):
        announce.announce("dt3d.location")
        announce.announce("dt3d.location")
        announce.announce("numpy.linalg")
    (record,) = caplog.records
    assert re.match(
        "compiling point location, some .* in every process, .*NUMBA_CACHE_DIR", record.getMessage()
    )


def test_every_part_has_modules_and_every_kernel_a_part():
    root = Path(dt3d.__file__).parent
    kernels = {
        "dt3d." + ".".join(path.relative_to(root).with_suffix("").parts)
        for path in root.rglob("*.py")
        if "@cached_njit" in path.read_text(encoding="utf-8")
    }
    found = {part_of(name) for name in kernels}
    assert found - {OTHER} == set(PARTS)
    assert part_of("dt3d.threaded2d.dag").name == "insertion in the plane"
    assert part_of("numpy.dt3d") is None
    others = {name for name in kernels if part_of(name) is OTHER}
    assert others <= {"dt3d._numba.kernel_cache", "dt3d._numba.atomics", "dt3d.experiments.kohout.busy"}

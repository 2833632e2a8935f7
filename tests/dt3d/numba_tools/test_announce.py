"""What a first call says that has to compile."""

import subprocess
import sys

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
compiled("dt3d.somewhere")(1)
compiled("dt3d.elsewhere")(1)
"""


def test_compiling_is_announced_once_and_only_where_it_is_ours():
    done = subprocess.run([sys.executable, "-c", COMPILE], capture_output=True, text=True, check=True)
    assert done.stdout == "now\n"
    assert done.stderr.startswith("compiling, which takes some ten to forty seconds once")
    assert done.stderr.count("\n") == 1

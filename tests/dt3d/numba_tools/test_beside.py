"""What a second process compiles meanwhile is found on disk; where none can, this one compiles as ever."""

import subprocess
import sys

import pytest

from dt3d._numba import beside
from dt3d._numba.beside import compiled_beside

MODULE = """
from numba.core import types
from dt3d._numba.kernel_cache import cached_njit

@cached_njit
def slow(x):
    return 3 * x

def compile_it():
    slow.compile((types.int64,))
"""

PROGRAM = """
import sys, threading
from numba.core import event
import dt3d._numba.beside as beside
beside.available_cores = lambda: int(sys.argv[1])
import module_of_a_test as m

compiled = []
class Listener(event.Listener):
    def on_start(self, e): compiled.append(e.data["dispatcher"].py_func.__name__)
    def on_end(self, e): pass

wait = beside.compiled_beside(m.slow, m.__name__, sys.argv[2])
wait()
event.register("numba:compile", Listener())
assert m.slow(7) == 21
print(compiled)
"""


def run(folder, *words):
    (folder / "module_of_a_test.py").write_text(MODULE)
    (folder / "program.py").write_text(PROGRAM)
    command = [sys.executable, str(folder / "program.py"), *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True, cwd=folder).stdout


@pytest.mark.parametrize(
    ("words", "compiled"),
    [
        (("2", "compile_it"), "[]"),
        (("1", "compile_it"), "['slow']"),  # one core: no second process
        (("2", "no_such_function"), "['slow']"),  # the second process fails
    ],
)
def test_it_is_found_on_disk_or_compiled(tmp_path, monkeypatch, words, compiled):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    assert run(tmp_path, *words).strip() == compiled
    assert run(tmp_path, "1", "compile_it").strip() == "[]"  # there now, whoever compiled it


class Kernel:
    """What is neither in memory nor on disk."""

    overloads = ()


@pytest.fixture
def missing(monkeypatch):
    monkeypatch.setattr(beside, "available_cores", lambda: 2)
    monkeypatch.setattr(beside, "is_kept", lambda kernel: False)


@pytest.mark.usefixtures("missing")
def test_no_process_is_no_error(monkeypatch):
    def refuse(*_, **__):
        raise OSError

    monkeypatch.setattr(beside.subprocess, "Popen", refuse)
    assert compiled_beside(Kernel(), "time", "sleep")() is None


@pytest.mark.usefixtures("missing")
def test_who_is_interrupted_leaves_no_process(monkeypatch):
    class Child:
        killed = waited = 0

        def wait(self):
            self.waited += 1
            if not self.killed:
                raise KeyboardInterrupt

        def kill(self):
            self.killed += 1

    child = Child()
    monkeypatch.setattr(beside.subprocess, "Popen", lambda *_, **__: child)
    with pytest.raises(KeyboardInterrupt):
        compiled_beside(Kernel(), "time", "sleep")()
    assert (child.killed, child.waited) == (1, 2)

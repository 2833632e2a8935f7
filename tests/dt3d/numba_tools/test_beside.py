"""What a second process compiles meanwhile is found on disk; where none can, this one compiles as ever."""

import io
import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest

from dt3d._numba import beside
from dt3d._numba.beside import compiled_beside

MODULE = """
from numba.core import types
from dt3d._numba.kernel_cache import cached_njit

@cached_njit
def slow(x):
    return 3 * x

@cached_njit
def seldom(x):
    return 5 * x

def compile_it():
    slow.compile((types.int64,))

def compile_more():
    seldom.compile((types.int64,))

def stay():
    import time
    time.sleep(600)
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

done = []
wait = beside.compiled_beside(m.slow, m.__name__, sys.argv[2], sys.argv[3], lambda: done.append("meanwhile"))
wait()
assert done == (["meanwhile"] if int(sys.argv[1]) > 1 else [])
event.register("numba:compile", Listener())
assert m.slow(7) == 21
print(compiled)
if sys.argv[3] == "compile_more":
    for child in tuple(beside.CHILDREN):
        child.wait()
    m.seldom(1)
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
        (("2", "compile_it", "compile_more"), "[]\n[]"),
        (("2", "compile_it", "stay"), "[]"),  # it ends with the program
        (("2", "compile_it", "no_such_function"), "[]"),
        (("1", "compile_it", "stay"), "['slow']"),  # one core: no second process
        (("2", "no_such_function", "stay"), "['slow']"),  # the second process fails
    ],
)
def test_it_is_found_on_disk_or_compiled(tmp_path, monkeypatch, words, compiled):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    assert run(tmp_path, *words).strip() == compiled
    assert run(tmp_path, "1", "compile_it", "stay").strip() == "[]"  # there now, whoever compiled it


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
    assert compiled_beside(Kernel(), "time", "sleep", "sleep", pytest.fail)() is None


class Child:
    """A process that says nothing until it is killed."""

    def __init__(self):
        self.killed, self.waited = threading.Event(), 0
        self.stdout = Silent(self.killed)

    def wait(self):
        assert self.killed.wait(60)
        self.waited += 1

    def kill(self):
        self.killed.set()


class Silent(io.BytesIO):
    """A pipe that ends with a process."""

    def __init__(self, ended):
        super().__init__()
        self.ended = ended
        self.was_closed = threading.Event()

    def read(self, size):
        assert self.ended.wait(60)
        return b""

    def close(self):
        super().close()
        self.was_closed.set()


@pytest.mark.usefixtures("missing")
@pytest.mark.parametrize("interrupted", ["while it compiles", "while it waits"])
def test_who_is_interrupted_leaves_no_process(monkeypatch, interrupted):
    child = Child()
    monkeypatch.setattr(beside.subprocess, "Popen", lambda *_, **__: child)
    done = []

    def meanwhile():
        done.append("meanwhile")
        if interrupted == "while it compiles":
            raise KeyboardInterrupt

    class Event(threading.Event):
        def wait(self, timeout=None):
            assert done == ["meanwhile"]  # before it waits
            raise KeyboardInterrupt

    monkeypatch.setattr(beside, "threading", SimpleNamespace(Event=Event, Thread=threading.Thread))
    wait = compiled_beside(Kernel(), "time", "sleep", "sleep", meanwhile)
    assert child in beside.CHILDREN
    with pytest.raises(KeyboardInterrupt):
        wait()
    assert child.killed.is_set()
    assert child.waited >= 1
    assert child.stdout.was_closed.wait(60)
    assert child not in beside.CHILDREN


@pytest.mark.usefixtures("missing")
def test_who_does_not_wait_leaves_nothing_open(monkeypatch):
    child = Child()
    monkeypatch.setattr(beside.subprocess, "Popen", lambda *_, **__: child)
    compiled_beside(Kernel(), "time", "sleep", "sleep", pytest.fail)
    child.kill()  # it ends by itself, after a call that failed before it came to the kernel
    assert child.stdout.was_closed.wait(60)

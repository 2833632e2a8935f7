"""Processes that are forked, as multiprocessing does on Linux up to Python 3.13."""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")

# runs in the child; a child that hangs is ended by the harness, and shows as a line that is missing
WORK = """
import multiprocessing, os, sys, threading, time
import numpy as np
import dt3d, scanvec as sv
from dt3d import predicates, threaded2d

PATIENCE = 240
points = np.random.default_rng(0).random((30, 3))

def on_jax():
    return sv.scan(sv.Device().vector([1, 2, 3]), sv.ADD).to_numpy().tolist()

def attempt(name, work):
    try:
        print(name, work(), sep=":", flush=True)
    except Exception as error:
        print(name, f"{type(error).__name__} {error}", sep=":", flush=True)

def in_child(vector, again=""):
    attempt(again + "device", on_jax)
    attempt(again + "simulated", lambda: sv.Simulated(4).iota(3).to_numpy().tolist())
    attempt(again + "vector", lambda: vector.to_numpy().tolist())
    attempt(again + "predicate", lambda: predicates.orient2d([0, 0], [1, 0], [0, 1], backend="jax"))
    attempt(again + "extrapolation", lambda: len(dt3d.Delaunay(points, method="extrapolation").simplices))
    attempt(again + "insertion", lambda: len(dt3d.Delaunay(points).simplices))
    attempt(again + "location", lambda: dt3d.Delaunay(points).find_simplex(points).min() >= 0)
    attempt(again + "plane", lambda: len(threaded2d.Delaunay(points[:, :2]).triangles))
    attempt(again + "end", str)

def ended(process):
    process.start()
    process.join(PATIENCE)
    if process.exitcode is None:
        process.kill()

def os_fork(vector):
    pid = os.fork()
    if not pid:
        in_child(vector)
        os._exit(0)
    begun = time.monotonic()
    while not os.waitpid(pid, os.WNOHANG)[0]:
        if time.monotonic() - begun > PATIENCE:
            os.kill(pid, 9)
        time.sleep(0.05)
"""

AFTER_JAX = """
if __name__ == "__main__":
    dt3d.Delaunay(points), threaded2d.Delaunay(points[:, :2])
    vector = sv.Device().vector([7, 8])
    on_jax()
    os_fork(vector)
    ended(multiprocessing.get_context("fork").Process(target=in_child, args=(vector, "again ")))
"""

BEFORE_JAX_AND_SPAWN = """
if __name__ == "__main__":
    ended(multiprocessing.get_context("fork").Process(target=attempt, args=("forked", on_jax)))
    attempt("parent", on_jax)
    ended(multiprocessing.get_context("spawn").Process(target=attempt, args=("spawned", on_jax)))
"""

OTHERS_RAN_JAX = """
if __name__ == "__main__":
    import jax.numpy as jnp
    jnp.arange(3).sum().block_until_ready()
    ended(multiprocessing.get_context("fork").Process(target=attempt, args=("device", on_jax)))
"""

LOCKS = """
if __name__ == "__main__":
    from numba.core.compiler_lock import global_compiler_lock
    from dt3d._numba.kernel_cache import cached_njit

    tri = dt3d.Delaunay(points)
    tri.find_simplex(points)
    with tri._locator.lock:  # as by another thread that locates points
        work = lambda: tri.find_simplex(points).min() >= 0
        ended(multiprocessing.get_context("fork").Process(target=attempt, args=("location", work)))

    compiled = cached_njit(lambda x: x + 1)
    begun = threading.Event()
    def compiling():
        with global_compiler_lock:
            begun.set()
            time.sleep(1)
    thread = threading.Thread(target=compiling)
    thread.start()
    begun.wait()
    ended(multiprocessing.get_context("fork").Process(target=attempt, args=("compiled", lambda: compiled(1))))
    thread.join()
"""


@pytest.fixture
def lines(tmp_path):
    """What a program prints, by name."""

    def run(program):
        script = tmp_path / "program.py"
        script.write_text(WORK + program)
        done = subprocess.run(
            [sys.executable, "-W", "ignore", str(script)],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        return dict(line.split(":", 1) for line in done.stdout.splitlines())

    return run


def test_forked_after_jax_has_run_is_an_error_that_names_spawn(lines):
    said = lines(AFTER_JAX)
    for again in ("", "again "):
        for name in ("device", "simulated", "vector", "predicate", "extrapolation"):
            assert said[again + name].startswith("RuntimeError this process was forked after JAX"), name
            assert "get_context('spawn')" in said[again + name]
        # what needs no JAX goes on
        assert int(said[again + "insertion"]) > 0
        assert said[again + "location"] == "True"
        assert int(said[again + "plane"]) > 0
        assert again + "end" in said


def test_forked_before_jax_has_run_works_and_so_does_spawn_as_advised(lines):
    assert lines(BEFORE_JAX_AND_SPAWN) == dict.fromkeys(["forked", "parent", "spawned"], "[0, 1, 3]")


@pytest.mark.slow
def test_forked_after_others_ran_jax_is_an_error_too(lines):
    assert lines(OTHERS_RAN_JAX)["device"].startswith("RuntimeError this process was forked after JAX")


def test_forked_while_a_thread_locates_or_compiles_the_child_does_so_too(lines):
    assert lines(LOCKS) == {"location": "True", "compiled": "2"}

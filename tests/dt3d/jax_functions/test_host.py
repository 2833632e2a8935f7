"""What the host does runs without JAX, in whole arithmetic, and ends."""

import subprocess
import sys
import threading
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import dt3d
from dt3d.jax import host, whole_arithmetic
from dt3d.jax.whole_arithmetic import in_unchanged_thread, in_whole_arithmetic, is_whole

from .sets import assert_same, uniform

REASON = "reason"

# The package is stood in for, as its own __init__ imports JAX; what imports JAX then fails.
WITHOUT_JAX = """
import importlib.util, sys, types
import numpy as np
import dt3d

class Poison:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("jax", "jaxlib", "scanvec"):
            raise AssertionError(f"the host imports {name}")

sys.meta_path.insert(0, Poison())
package = types.ModuleType("dt3d.jax")
package.__path__ = [sys.argv[1]]
sys.modules["dt3d.jax"] = package
from dt3d.jax import host, whole_arithmetic

for d in (2, 3):
    sets = np.random.default_rng(0).random((3, 50, d))
    sets[2] = 1
    results = [np.empty((3, *shape), np.int32) for shape in ((400, d + 1), (400, d + 1), (), ())]
    simplices, neighbors, count, status = results
    host.triangulate_with_status([sets], results)
    assert count[0] == len(dt3d.Delaunay(sets[0]).simplices) and status.tolist() == [0, 0, 4]
    found = np.empty((3, 7), np.int32)
    host.locate([sets, simplices, neighbors, sets[:, :7] * 0.5 + 0.25], [found])
    assert (found[:2] >= 0).any() and (found[2] == -1).all()
try:
    host.triangulate_or_raise([sets], [a[:, :4] for a in results[:2]] + results[2:])
except ValueError as error:
    assert "more than capacity=4" in str(error)
assert not {"jax", "jaxlib"} & set(sys.modules)
print("done")
"""

MANY = """
import threading
import jax, jax.numpy as jnp, numpy as np
import dt3d, dt3d.jax

def program(points, xi):
    mesh = dt3d.jax.delaunay(points, on_error="status")
    values = dt3d.jax.interpolate(points, mesh, points[..., 0], xi, fill_value=0.0)
    return dt3d.jax.volumes(points, mesh).sum() + values.sum(), mesh.count

one = jax.jit(jax.value_and_grad(program, has_aux=True))
many = jax.jit(jax.vmap(jax.value_and_grad(program, has_aux=True)))
sets = np.random.default_rng(0).random((4, 5, 30, 3)).astype(np.float32)
expected = [[len(dt3d.Delaunay(points).simplices) for points in batch] for batch in sets]
wrong = []
# more than the 100 kB that JAX copies at once, and calls that nobody has waited for: with jax.pure_callback
# this hangs on two cores
large = jnp.asarray(np.random.default_rng(1).random((15_000, 2)), jnp.float32)
located = jax.jit(lambda p: dt3d.jax.find_simplex(p, dt3d.jax.delaunay(p), p[:9]).min())


def repeat(k):
    in_flight = [located(large + i) for i in range(6)]
    if min(int(found) for found in in_flight) < 0:
        wrong.append(k)
    for i in range(250):
        batch = jnp.asarray(sets[k])
        if i % 5:
            (_, count), _ = one(batch[i % 5], batch[0, :9])
            right = int(count) == expected[k][i % 5]
        else:
            (_, count), _ = many(batch, batch[:, :9])
            right = count.tolist() == expected[k]
        if not right:
            wrong.append((k, i))

threads = [threading.Thread(target=repeat, args=(k,)) for k in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert not wrong, wrong
print("done")
"""


def run(code, *arguments):
    # a hang ends after two minutes
    command = [sys.executable, "-c", code, *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def test_the_host_never_calls_jax():
    out = run(WITHOUT_JAX, str(Path(host.__file__).parent))
    assert (out.returncode, out.stdout) == (0, "done\n"), out.stderr


def test_a_thousand_calls_from_four_threads_do_not_hang():
    out = run(MANY)
    assert (out.returncode, out.stdout) == (0, "done\n"), out.stderr


@pytest.fixture
def starter():
    """The thread that starts others where the C library does not serve."""
    whole_arithmetic.begin()
    yield
    whole_arithmetic.end()


def test_the_first_set_that_fails_is_named_whichever_thread_is_first(monkeypatch):
    monkeypatch.setattr(host, "available_cores", lambda: 3)
    third_has_failed = threading.Event()

    def work(k, threads):
        if k == 2:
            third_has_failed.set()
        elif k == 1:
            assert third_has_failed.wait(60)
        if k > 0:
            msg = f"set {k}"
            raise ValueError(msg)

    with pytest.raises(ValueError, match="set 1"):
        host._for_each(8, True, work)


@pytest.mark.usefixtures("starter", "on_cpu")
@pytest.mark.parametrize("with_the_c_library", [True, False])
def test_arithmetic_is_whole_where_that_of_xla_is_not(monkeypatch, with_the_c_library):
    if not with_the_c_library:
        monkeypatch.setattr(whole_arithmetic, "_C", None)
    seen = []

    def in_a_thread_of_its_own():
        thread = threading.Thread(target=lambda: seen.append(is_whole()))
        thread.start()
        thread.join()

    def call(x):
        seen.append(is_whole())
        in_whole_arithmetic(lambda: seen.append(is_whole()))
        in_whole_arithmetic(in_a_thread_of_its_own)
        seen.append(is_whole())
        return x

    jax.block_until_ready(jax.jit(lambda x: jax.pure_callback(call, x, x))(jnp.zeros(3)))
    # if XLA's thread says True one day, the module is not needed any more
    assert seen == [False, True, True, False]


@pytest.mark.usefixtures("starter")
@pytest.mark.parametrize("where", [in_whole_arithmetic, in_unchanged_thread])
def test_what_is_raised_comes_to_the_caller(where):
    def fail():
        raise KeyError(REASON)

    with pytest.raises(KeyError, match="reason"):
        where(fail)


def test_sets_get_one_thread_each(monkeypatch):
    monkeypatch.setattr(host, "available_cores", lambda: 3)
    seen = []
    together = threading.Barrier(3, timeout=60)

    def work(k, threads):
        seen.append((k, threads))
        together.wait()

    host._for_each(6, True, work)
    assert sorted(seen) == [(k, 1) for k in range(6)]
    seen.clear()
    host._for_each(2, False, lambda *call: seen.append(call))
    assert seen == [(0, None), (1, None)]


def test_a_failure_stops_the_other_threads(monkeypatch):
    monkeypatch.setattr(host, "available_cores", lambda: 2)
    seen = []

    def work(k, threads):
        seen.append(k)
        if k == 1:
            raise ValueError(REASON)

    with pytest.raises(ValueError, match="reason"):
        host._for_each(10**6, True, work)
    assert len(seen) < 10**6


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="this system has no fork")
def test_a_forked_process_has_a_starter_of_its_own():
    code = """
import os, sys, jax, dt3d.insertion
sys.platform = "elsewhere"  # where the C library is not called
from dt3d.jax.whole_arithmetic import HAS_FESETENV, in_unchanged_thread
assert not HAS_FESETENV
child = os.fork()
if not child:
    os._exit(in_unchanged_thread(lambda: 7))
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    assert run(code).stdout == "7\n"


def test_batches_of_one_core(monkeypatch):
    monkeypatch.setattr(host, "available_cores", lambda: 1)
    sets = np.stack([uniform(20, 2, seed).astype(np.float32) for seed in range(3)])
    mesh = dt3d.jax.delaunay(sets)
    for k in range(3):
        assert_same(jax.tree.map(lambda a, k=k: a[k], mesh), sets[k].astype(np.float64))

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
from dt3d.jax import host
from dt3d.jax.whole_arithmetic import in_whole_arithmetic

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
from dt3d.jax import host

for d in (2, 3):
    sets = np.random.default_rng(0).random((3, 50, d))
    sets[2] = 1
    simplices, neighbors, count, status = host.triangulator(400, False)(sets)
    assert count[0] == len(dt3d.Delaunay(sets[0]).simplices) and status.tolist() == [0, 0, 4]
    (found,) = host.locate(sets, simplices, neighbors, sets[:, :7] * 0.5 + 0.25)
    assert found.shape == (3, 7) and (found[:2] >= 0).any() and (found[2] == -1).all()
try:
    host.triangulator(4, True)(sets)
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

def repeat(k):
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


def test_threads_are_of_whole_arithmetic_where_xla_is_not():
    smallest = np.float64(5e-324)
    seen = {}

    def call(x):
        seen["callback"] = bool(smallest * np.float64(1) > 0)
        seen["ours"] = in_whole_arithmetic(lambda: bool(smallest * np.float64(1) > 0))
        return np.asarray(x)

    jax.block_until_ready(jax.jit(lambda x: jax.pure_callback(call, x, x))(jnp.zeros(3)))
    # if XLA's thread says True one day, the module is not needed any more
    assert seen == {"callback": False, "ours": True}


def test_what_is_raised_comes_to_the_caller():
    def fail():
        raise KeyError(REASON)

    with pytest.raises(KeyError, match="reason"):
        in_whole_arithmetic(fail)


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
def test_a_process_forked_before_jax_ran():
    code = """
import os, numpy as np
import dt3d.jax
from dt3d.jax.whole_arithmetic import in_whole_arithmetic
child = os.fork()
if not child:
    os._exit(in_whole_arithmetic(lambda: 7))
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    assert run(code).stdout == "7\n"


def test_batches_of_one_core(monkeypatch):
    monkeypatch.setattr(host, "available_cores", lambda: 1)
    sets = np.stack([uniform(20, 2, seed).astype(np.float32) for seed in range(3)])
    mesh = dt3d.jax.delaunay(sets)
    for k in range(3):
        assert_same(jax.tree.map(lambda a, k=k: a[k], mesh), sets[k].astype(np.float64))

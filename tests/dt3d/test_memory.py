"""Memory that is not there: an error that says what was needed, and the next call works."""

import subprocess
import sys
import threading

import numpy as np
import pytest

import dt3d
from dt3d import _memory, threaded2d
from dt3d.insertion import store
from dt3d.insertion.mesh import aligned


@pytest.fixture
def no_thread(monkeypatch):
    """A system that refuses threads, as under a small `ulimit -v`."""

    def refuse(self):
        msg = "can't start new thread"
        raise RuntimeError(msg)

    monkeypatch.setattr(threading.Thread, "start", refuse)


def test_a_thread_that_the_system_refuses_is_a_memory_error(no_thread, monkeypatch):
    monkeypatch.setattr("dt3d.insertion.driver.available_cores", lambda: 2)
    points = np.random.default_rng(0).random((8000, 3))
    with pytest.raises(MemoryError, match="refused another thread.*threads=1"):
        dt3d.Delaunay(points, threads=2)
    dt3d.Delaunay(points, threads=1)  # as the message advises


def test_a_thread_refused_to_location_is_a_memory_error(no_thread, monkeypatch):
    monkeypatch.setattr("dt3d.location.available_cores", lambda: 2)
    points = np.random.default_rng(0).random((100, 3))
    tri = dt3d.Delaunay(points)
    many = np.random.default_rng(1).random((20_000, 3))
    within = (many >= points.min(axis=0)).all(axis=1) & (many <= points.max(axis=0)).all(axis=1)
    many = many[within][:8192]
    with pytest.raises(MemoryError, match="refused another thread.*fewer than 8192 points"):
        tri.find_simplex(many)
    assert (tri.find_simplex(many[1:]) >= -1).all()  # as the message advises


def test_points_are_refused_before_they_are_located(memory):
    for tri, d in ((dt3d.Delaunay(uniform(100)), 3), (threaded2d.Delaunay(uniform(100, 2)), 2)):
        memory(1e6)
        with pytest.raises(MemoryError, match="locating 10000 points needs about"):
            tri.find_simplex(uniform(10_000, d))
        assert (tri.find_simplex(uniform(5000, d)) >= -1).all()
        memory(1e9)


@pytest.fixture
def memory(monkeypatch):
    """``memory(n)``: from now on there are n bytes more than the margin, and every step looks."""

    def leave(n):
        monkeypatch.setattr(_memory, "SMALL", 0)
        monkeypatch.setattr(_memory, "available_memory", lambda: _memory.MARGIN + int(n))

    return leave


def uniform(n, d=3):
    return np.random.default_rng(0).random((n, d))


def moments(n):
    """Sites on a curve, all pairs of which are edges."""
    t = np.linspace(0.1, 1, n)
    return np.column_stack([t, t**2, t**3])


def test_too_many_sites_are_refused_before_anything_is_done(memory):
    memory(1e6)
    with pytest.raises(MemoryError, match=r"the triangulation of 10000 sites needs about 70.9 MB more"):
        dt3d.Delaunay(uniform(10_000))
    dt3d.Delaunay(uniform(1000))


def test_quadratically_many_tetrahedra_are_refused_when_there_is_no_room_for_twice_as_many(memory):
    memory(1e6)
    with pytest.raises(MemoryError, match="a triangulation of more than [0-9]+ tetrahedra needs about"):
        dt3d.Delaunay(moments(400))
    dt3d.Delaunay(uniform(400))


def test_slots_are_refused_when_they_would_be_written(memory, monkeypatch):
    """Memory that others have taken since it was reserved."""
    monkeypatch.setattr(store, "SLOTS_PER_CHECK", 100)
    memory(1e6)
    slots = store.Store(aligned(16, np.float64), np.arange(4, dtype=np.uint32), 1000, block=50, assured=300)
    for _ in range(8):
        slots.take_block()
    assert 300 < slots.used <= slots.assured < 500
    memory(0)
    while slots.used < slots.assured:
        slots.take_block()
    with pytest.raises(MemoryError, match="a triangulation of more than [0-9]+ tetrahedra needs about"):
        slots.take_block()
    assert slots.lock.acquire(blocking=False)


def test_doubling_needs_the_old_and_the_new_half_at_once(memory):
    first = np.arange(4, dtype=np.uint32)
    memory(64 * 600)
    small = store.Store(aligned(16, np.float64), first, 1000, 10)
    small.used = 1000
    small.grow()
    assert small.capacity == 2000
    small.used = 2000
    with pytest.raises(MemoryError, match="more than 2000 tetrahedra"):
        small.grow()
    assert small.capacity == 2000
    assert len(small.tetrahedra) == 8 * 2000


def test_more_tetrahedra_than_32_bits_name_is_an_error_that_says_the_limit(monkeypatch):
    for module in ("store", "driver"):
        monkeypatch.setattr(f"dt3d.insertion.{module}.MOST_SLOTS", 10_000)
    with pytest.raises(ValueError, match="name at most 10000 = 2\\^30; triangulate fewer sites at a time"):
        dt3d.Delaunay(moments(400))
    # up to the limit, though it is no doubling of what there was
    assert len(dt3d.Delaunay(moments(120)).simplices) > 6900


def test_the_plane_is_refused_with_and_without_a_history(memory):
    memory(1e6)
    for method in ("auto", "sequential"):
        with pytest.raises(MemoryError, match="the triangulation of 10000 sites in the plane needs about"):
            threaded2d.Delaunay(uniform(10_000, 2), method=method)
    tri = threaded2d.Delaunay(uniform(1000, 2))
    memory(1e5)
    with pytest.raises(MemoryError, match="verifying [0-9]+ triangles needs about"):
        tri.verify()


def test_what_comes_after_is_refused_and_the_triangulation_stays(memory):
    tri = dt3d.Delaunay(uniform(3000))
    memory(1e5)
    with pytest.raises(MemoryError, match="finding the neighbors of 3000 vertices needs about"):
        tri.vertex_neighbor_vertices  # noqa: B018
    with pytest.raises(MemoryError, match="verifying [0-9]+ simplices needs about"):
        tri.verify()
    memory(1e9)
    assert len(tri.vertex_neighbor_vertices[0]) == 3001
    assert tri.verify()


def test_extrapolation_is_refused_before_it_compiles(memory):
    memory(1e6)
    with pytest.raises(MemoryError, match="the extrapolation of 3000 sites needs about"):
        dt3d.Delaunay(uniform(3000), method="extrapolation")


# what there is


def files(root, **texts):
    for name, text in texts.items():
        path = root / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


MEMINFO = "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable: 3000 kB\nSwapFree: 500 kB\nHugePages_Total: 0\n"


def test_memory_of_a_machine_without_limits(tmp_path):
    files(tmp_path, proc__meminfo=MEMINFO, proc__self__cgroup="0::/\n")
    assert _memory.available_memory(tmp_path) == 3500 * 1024


def test_memory_of_a_container(tmp_path):
    """Version 2: the least that is left in its group and those around it; cached files count as free."""
    files(tmp_path, proc__meminfo=MEMINFO, proc__self__cgroup="0::/pod/box\n")
    groups = tmp_path / "sys/fs/cgroup"
    for group, limit, taken in (("pod", "2000000", 500_000), ("pod/box", "max", 400_000)):
        (groups / group).mkdir(parents=True)
        (groups / group / "memory.max").write_text(f"{limit}\n")
        (groups / group / "memory.current").write_text(f"{taken}\n")
    assert _memory.available_memory(tmp_path) == 1_500_000
    (groups / "pod/memory.stat").write_text("anon 300000\ninactive_file 200000\n")
    assert _memory.available_memory(tmp_path) == 1_700_000
    (groups / "pod/box/memory.max").write_text("1000000\n")
    assert _memory.available_memory(tmp_path) == 600_000


def test_memory_of_a_container_that_sees_its_group_as_the_root(tmp_path):
    files(tmp_path, proc__meminfo=MEMINFO, proc__self__cgroup="0::/\n")
    (tmp_path / "sys/fs/cgroup").mkdir(parents=True)
    (tmp_path / "sys/fs/cgroup/memory.max").write_text("800000\n")
    (tmp_path / "sys/fs/cgroup/memory.current").write_text("300000\n")
    assert _memory.available_memory(tmp_path) == 500_000


def test_memory_of_a_container_of_version_1(tmp_path):
    files(tmp_path, proc__meminfo=MEMINFO, proc__self__cgroup="5:cpu,cpuacct:/a\n4:memory:/box\n")
    box = tmp_path / "sys/fs/cgroup/memory/box"
    box.mkdir(parents=True)
    (box / "memory.limit_in_bytes").write_text("900000\n")
    (box / "memory.usage_in_bytes").write_text("500000\n")
    (box / "memory.stat").write_text("inactive_file 7\ntotal_inactive_file 100000\n")
    assert _memory.available_memory(tmp_path) == 500_000


def test_a_system_that_says_nothing_of_its_memory_is_not_limited(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "psutil", None)
    assert _memory.available_memory(tmp_path) == _memory.UNKNOWN


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc is Linux's")
def test_this_system_says_what_it_has():
    assert 0 < _memory.available_memory() < 2**50


LITTLE = """
import resource
import numpy as np, dt3d
from dt3d import threaded2d

points = np.random.default_rng(0).random((1_000_000, 3))
dt3d.Delaunay(points[:5000], threads=1)
threaded2d.Delaunay(points[:5000, :2], threads=1)
taken = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (taken + 150_000_000,) * 2)
for work in (lambda: dt3d.Delaunay(points, threads=1), lambda: threaded2d.Delaunay(points[:, :2], threads=1)):
    try:
        work()
    except MemoryError as error:
        print(error)
print(len(dt3d.Delaunay(points[:20_000], threads=1).simplices) > 120_000)
print(len(threaded2d.Delaunay(points[:20_000, :2], threads=1).triangles) > 39_000)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits of address space are Linux's")
def test_little_address_space_is_an_error_with_a_sentence_and_the_next_call_works():
    done = subprocess.run([sys.executable, "-c", LITTLE], capture_output=True, text=True, check=True)
    space, plane, *work = done.stdout.splitlines()
    assert space.startswith("the triangulation of 1000000 sites needs about")
    assert plane.startswith("the triangulation of 1000000 sites in the plane needs about")
    for line in (space, plane):
        assert line.endswith("are left of this process's address space (ulimit -v)")
    assert work == ["True", "True"]

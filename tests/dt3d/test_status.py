"""How the command line ends: one line and a status for what can go wrong, whoever reads the output."""

import errno
import io
import os
import re
import signal
import subprocess
import sys

import numpy as np
import pytest

import dt3d
from dt3d import _status, cli
from dt3d.bench.worker import _without_interrupts
from dt3d.files import read_mesh

from .disks import small_files

OLD = b"the old file, which somebody may need\n"


@pytest.fixture
def points(tmp_path):
    """A file of 60 random sites."""
    path = tmp_path / "sites.npy"
    np.save(path, np.random.default_rng(5).random((60, 3)))
    return path


def command(*words):
    return cli.main([str(word) for word in words])


def fails(capsys, *words):
    """Runs a command that must fail with status 2 and one line; returns the line."""
    assert command(*words) == 2
    out, err = capsys.readouterr()
    assert err.startswith("dt3d: ")
    assert err.count("\n") == 1
    assert err.isprintable() or err[:-1].isprintable()
    assert "Traceback" not in out + err
    return err


class XlaRuntimeError(RuntimeError):
    """Named as JAX names all its errors."""


# what is raised, the status, and what is printed


@pytest.mark.parametrize(
    ("error", "status", "line"),
    [
        (ValueError("two\n  lines\n"), 2, "dt3d: two lines"),
        (ValueError(), 2, "dt3d: ValueError"),
        (ValueError("\x1b]0;title\x07 [red]x[/nothing]"), 2, r"dt3d: \x1b]0;title\x07 [red]x[/nothing]"),
        (ValueError("\udcff and ü"), 2, r"dt3d: \udcff and ü"),
        (
            FileNotFoundError(errno.ENOENT, "there is none", "a\nb"),
            2,
            r"dt3d: [Errno 2] there is none: 'a\nb'",
        ),
        (ImportError("no such package"), 2, "dt3d: no such package"),
        (dt3d.DegenerateInputError("on a plane", 2), 2, "dt3d: on a plane"),
        (dt3d.InconsistencyError("too many", 7), 2, "dt3d: too many"),
        (MemoryError(), 2, "dt3d: there is not enough memory: the system gave none"),
        (MemoryError("3 GiB"), 2, "dt3d: there is not enough memory: 3 GiB"),
        (XlaRuntimeError("RESOURCE_EXHAUSTED: 3 GiB"), 2, "not enough memory: RESOURCE_EXHAUSTED: 3 GiB"),
        (SystemExit(1), 2, "dt3d: a library gave up on the input: 1"),
        (dt3d.InternalError("a walk does not end"), 70, "dt3d: a walk does not end. This is a fault of dt3d"),
        (BrokenPipeError(), 141, ""),
        (KeyboardInterrupt(), 130, "interrupted"),
    ],
    ids=str,
)
def test_what_is_raised_has_a_status_and_one_line(points, tmp_path, monkeypatch, capsys, error, status, line):
    def ends(*_, **__):
        raise error

    monkeypatch.setattr(dt3d, "Delaunay", ends)
    assert command("triangulate", points, "-o", tmp_path / "a.npz") == status
    err = capsys.readouterr().err
    assert line in err
    assert err.count("\n") == bool(line)
    assert os.listdir(tmp_path) == ["sites.npy"]


@pytest.mark.parametrize(
    "error", [KeyError("x"), RuntimeError("RESOURCE"), RecursionError("deep"), AssertionError()]
)
def test_a_fault_keeps_its_traceback_and_asks_for_a_report(points, tmp_path, monkeypatch, capsys, error):
    def ends(*_, **__):
        raise error

    monkeypatch.setattr(dt3d, "Delaunay", ends)
    assert command("triangulate", points, "-o", tmp_path / "a.npz") == 70
    err = capsys.readouterr().err
    assert "Traceback" in err
    assert "in ends" in err
    assert err.splitlines()[-1].startswith("dt3d: this is a fault of dt3d")


# Ctrl-C


def interrupt():
    signal.raise_signal(signal.SIGINT)


class Dropped:
    """An object in whose destructor Ctrl-C comes; Python drops what is raised there."""

    def __del__(self):
        interrupt()


def test_ctrl_c_that_gets_lost_counts(points, tmp_path, monkeypatch, capsys):
    real = dt3d.Delaunay

    def in_a_destructor(*words, **options):
        Dropped()
        return real(*words, **options)

    def as_another_error(*_, **__):
        try:
            interrupt()
        except KeyboardInterrupt as error:
            msg = "INTERNAL: a callback failed"
            raise RuntimeError(msg) from error

    def twice(*_, **__):
        try:
            interrupt()
        finally:
            interrupt()

    handler = signal.getsignal(signal.SIGINT)
    for way in (in_a_destructor, as_another_error, twice):
        monkeypatch.setattr(dt3d, "Delaunay", way)
        assert command("triangulate", points, "-o", tmp_path / "a.npz") == 130
        err = capsys.readouterr().err
        assert err.endswith("interrupted\n")
        assert "Traceback" not in err
        assert signal.getsignal(signal.SIGINT) is handler


def test_ctrl_c_while_it_ends(points, tmp_path, monkeypatch, capsys):
    """Once all is done nothing is raised in the middle of the report."""
    real = _status._end

    def end(*words):
        interrupt()
        return real(*words)

    monkeypatch.setattr(_status, "_end", end)
    assert "there is no file" in fails(capsys, "triangulate", tmp_path / "no.npy", "-o", tmp_path / "a.npz")


def test_where_ctrl_c_is_ignored_it_stays_ignored(points, tmp_path, monkeypatch):
    real = dt3d.Delaunay

    def way(*words, **options):
        interrupt()
        return real(*words, **options)

    monkeypatch.setattr(dt3d, "Delaunay", way)
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert command("triangulate", points, "-o", tmp_path / "a.npz") == 0
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="signals cannot be held back here")
def test_ctrl_c_does_not_reach_the_processes_of_a_benchmark():
    code = "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []))"

    def start():
        with _without_interrupts():
            process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
            interrupt()
            started.append(process)

    started = []
    with pytest.raises(KeyboardInterrupt):  # this process hears it, a moment later
        start()
    assert started[0].communicate()[0] == "True\n"
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])


INTERRUPTED = """
import atexit, os, signal, sys

class Finder:
    def find_spec(self, name, *_):
        if name == {module!r}:
            os.kill(os.getpid(), signal.SIGINT)
        if name == "jax" and {module!r} == "the end":
            atexit.register(os.kill, os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Finder())
from dt3d._command import main
sys.argv = ["dt3d", *{words!r}]
sys.exit(main())
"""


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("dt3d.cli", []),  # before anything of ours
        ("cyclopts", []),  # while libraries load
        ("dt3d.plot", ["view", "none.vtu", "--screenshot", "none.png"]),  # within one of them
        ("the end", ["experiment"]),
    ],
)
def test_ctrl_c_before_and_after_the_commands(module, words):
    code = INTERRUPTED.format(module=module, words=words)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 130
    assert done.stderr == "interrupted\n"


def test_a_package_that_is_missing_is_one_line(monkeypatch, capsys):
    from dt3d import _command

    monkeypatch.setitem(sys.modules, "dt3d.cli", None)
    handler = signal.getsignal(signal.SIGINT)
    try:
        assert _command.main() == 2
    finally:
        signal.signal(signal.SIGINT, handler)
    assert re.fullmatch("dt3d: .*dt3d.cli.*\n", capsys.readouterr().err)


# whoever reads the output


# each case in a process of its own, which is forked from one that has loaded everything
STREAMS = """
import os, sys
import dt3d.cli
from dt3d import _command

def case(words, out, err):
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    sys.argv = ["dt3d", *words]
    reader, broken = os.pipe()
    os.close(reader)
    log = os.open({log!r}, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    for number, what in ((1, out), (2, err)):
        if what == "closed":
            setattr(sys, {{1: "stdout", 2: "stderr"}}[number], None)
            os.close(number)
        else:
            opened = {{"broken": broken, "log": log}}.get(what) or os.open(what, os.O_WRONLY)
            os.dup2(opened, number)
    sys.exit(_command.main())

import dt3d.experiments
print(*[case(*row) for row in {table!r}])
"""
LISTED = ["experiment"]
WRONG = ["experiment", "none"]
CASES = [  # words, standard output, standard error, status
    (LISTED, "broken", "log", 141),
    (["--help"], "broken", "log", 141),
    (["--version"], "broken", "log", 141),
    (["triangulate", "POINTS", "-o", "MESH"], "broken", "log", 141),
    (LISTED, "closed", "log", 0),
    (LISTED, "/dev/full", "log", 2),
    (LISTED, "log", "closed", 0),
    (WRONG, "log", "broken", 2),
    (WRONG, "closed", "closed", 2),
    (WRONG, "log", "/dev/full", 2),
    (["what"], "log", "broken", 2),
]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no such device")
def test_output_that_nobody_reads(points, tmp_path):
    log, mesh = tmp_path / "log", tmp_path / "mesh.npz"
    mesh.write_bytes(OLD)
    names = {"POINTS": str(points), "MESH": str(mesh)}
    table = [([names.get(word, word) for word in words], *streams) for words, *streams, _ in CASES]
    code = [sys.executable, "-W", "ignore", "-c", STREAMS.format(log=str(log), table=table)]
    done = subprocess.run(code, capture_output=True, text=True, check=True)
    assert [int(status) for status in done.stdout.split()] == [status for *_, status in CASES]
    assert done.stderr == ""
    lines = log.read_text()
    assert [line for line in lines.splitlines() if line.startswith("dt3d: ")] == [
        "dt3d: cannot print: No space left on device"
    ]
    assert "Traceback" not in lines
    assert "Exception ignored" not in lines
    assert mesh.read_bytes() == OLD


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-8"])
def test_terminals_that_lack_signs(tmp_path, monkeypatch, encoding):
    (tmp_path / "a[").mkdir()
    source = tmp_path / os.fsdecode("a[/x] :star:Å[red]\n\x1b ".encode() + b"\xff.npy")
    with source.open("wb") as file:
        np.save(file, np.random.default_rng(5).random((60, 3)))
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding=encoding) for _ in range(2))
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    assert command("triangulate", source, "-o", tmp_path / "a.npz") == 0
    assert command("triangulate", source, "-o", tmp_path / os.fsdecode(b"\xfe/a.npz")) == 2
    for stream in (out, err):
        assert stream.errors == "strict"  # as it was
        lines = stream.buffer.getvalue().decode(encoding)
        assert r"\udcff" in lines or r"\udcfe" in lines
        assert "\x1b" not in lines
    assert "a[/x] :star:" in out.buffer.getvalue().decode(encoding)


# files


@pytest.mark.parametrize(
    "name",
    ["a.npz", "a.vtu", "a.vtk", "a.msh", "a.mesh", "a.ply", "a.stl", "a.png", "a.pdf", "a.svg", "a.jpg"],
)
def test_a_full_disk_is_one_line_and_status_2(points, tmp_path, monkeypatch, capsys, name):
    tri = dt3d.Delaunay(np.load(points))  # before the limit, which numba's files of machine code would meet
    monkeypatch.setattr(dt3d, "Delaunay", lambda *_, **__: tri)
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / name).write_bytes(OLD)
    words = ["triangulate", points, "-o", folder / name]
    if name.partition(".")[2] in ("png", "pdf", "svg", "jpg"):
        words[2:] = ["-o", tmp_path / "a.npz", "--picture", folder / name]
        limit = 8000  # the mesh is smaller
    else:
        limit = 900
    with small_files(limit):
        assert "File too large" in fails(capsys, *words)
    assert (folder / name).read_bytes() == OLD
    assert os.listdir(folder) == [name]


def test_targets_that_cannot_be_written_end_it_before_it_begins(points, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(dt3d, "Delaunay", None)
    mesh, picture = tmp_path / "a.vtu", tmp_path / "a.png"
    mesh.mkdir()
    picture.mkdir()
    assert "a.vtu: it is a folder" in fails(capsys, "triangulate", points, "-o", mesh)
    words = ["triangulate", points, "-o", tmp_path / "b.vtu", "--picture"]
    assert "a.png: it is a folder" in fails(capsys, *words, picture)
    assert "there is no folder" in fails(capsys, *words, tmp_path / "no" / "b.png")


def test_output_that_is_the_input_is_refused_unless_forced(points, tmp_path, capsys):
    mesh = tmp_path / "a.npz"
    assert command("triangulate", points, "-o", mesh) == 0
    capsys.readouterr()
    before = mesh.read_bytes()
    links = [tmp_path / "soft.npz", tmp_path / "hard.npz"]
    links[0].symlink_to(mesh)
    os.link(mesh, links[1])
    for output in (mesh, *links):
        assert "are one file, which would be replaced; name another file, or say --force" in fails(
            capsys, "triangulate", mesh, "-o", output
        )
    picture = tmp_path / "a.png"
    picture.symlink_to(mesh)
    words = ["triangulate", mesh, "-o", tmp_path / "b.npz", "--picture", picture]
    assert "one file" in fails(capsys, *words)
    assert "one file" in fails(capsys, *words, "--force")
    assert "one file" in fails(capsys, "triangulate", points, "-o", mesh, "--picture", picture, "--force")
    assert "one file" in fails(capsys, "view", mesh, "--screenshot", picture)
    assert mesh.read_bytes() == before
    # the way out that the line names
    assert command("triangulate", mesh, "-o", mesh, "--force") == 0
    assert len(read_mesh(mesh).points) == 60


def test_a_benchmark_does_not_replace_the_points_it_reads(tmp_path, capsys):
    path = tmp_path / "bench.csv"
    path.write_bytes(b"x,y,z\n1,2,3\n")
    assert "one file" in fails(capsys, "bench", "--file", path, "--distributions", "ring", "--out", tmp_path)
    assert path.read_bytes() == b"x,y,z\n1,2,3\n"

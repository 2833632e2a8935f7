"""Files are written whole or not at all: full disks, Ctrl-C, signals, and targets that cannot be written."""

import errno
import os
import stat
import subprocess
import sys
import tempfile
import threading
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import scanvec as sv
from dt3d._output import write_csv
from dt3d._paths import check_apart, check_writable, written_aside
from dt3d.files import read_mesh, write_mesh
from dt3d.plot import draw

from .disks import small_files

MESHES = [".npz", ".vtu", ".vtk", ".msh", ".mesh", ".ply", ".stl"]
PICTURES = [".png", ".pdf", ".svg", ".jpg"]
TABLES = [".csv"]
OLD = b"the old file, which somebody may need\n"
LIMIT = 4_096  # bytes, which is less than every one of these files has


@pytest.fixture(scope="module")
def big():
    """A triangulation's arrays, of which each format makes far more than LIMIT bytes."""
    rng = np.random.default_rng(0)
    simplices = rng.permuted(np.tile(np.arange(1000, dtype=np.int32), (500, 1)), axis=1)[:, :4]
    return SimpleNamespace(
        points=rng.random((1000, 3)),
        simplices=simplices,
        neighbors=simplices,
        convex_hull=simplices[:, :3],
        iteration=np.ones(500, np.int32),
    )


def save(big, path):
    """Write the triangulation in the format of the extension."""
    if path.suffix in MESHES:
        write_mesh(big, path)
    elif path.suffix in PICTURES:
        draw(big, path, width=300, height=250)
    else:
        write_csv(path, ["x", "y", "z"], np.tile(big.points, (4, 1)))


@pytest.fixture(params=[*MESHES, *PICTURES, *TABLES])
def target(request, tmp_path):
    """A file of that extension, which is there, alone in its folder."""
    folder = tmp_path / "folder"
    folder.mkdir()
    path = folder / f"old{request.param}"
    path.write_bytes(OLD)
    return path


def is_as_it_was(path):
    """The old file is whole, and nothing was left beside it."""
    assert path.read_bytes() == OLD
    assert os.listdir(path.parent) == [path.name]


def test_a_good_file_takes_the_place_of_the_old_one(big, target):
    save(big, target)
    assert target.stat().st_size > LIMIT
    assert os.listdir(target.parent) == [target.name]


def test_a_full_disk_leaves_the_old_file(big, target):
    whole = target.with_name("whole" + target.suffix)
    save(big, whole)
    size = whole.stat().st_size
    whole.unlink()
    # libraries that write by several ways overlook a part that is short at the end of one of them
    for limit in (0, LIMIT, size - 5000, size - 100, size - 1):
        with small_files(max(0, limit)), pytest.raises(OSError, match=r"."):
            save(big, target)
        is_as_it_was(target)


def test_a_full_disk_names_the_file(big, target):
    with (
        small_files(LIMIT),
        pytest.raises(OSError, match=r"cannot write .*old\..*; the old file is as it was$") as caught,
    ):
        save(big, target)
    assert ".dt3d-" not in str(caught.value)
    target.unlink()
    with small_files(LIMIT), pytest.raises(OSError, match=r"cannot write .*old\.[a-z]+: [A-Za-z0-9 ]+$"):
        save(big, target)
    assert os.listdir(target.parent) == []


@pytest.fixture
def full_disk(tmp_path):
    """A file system of its own with a few kilobytes, where we may mount one."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(folder)]
    try:
        done = subprocess.run(mount, capture_output=True, check=False)
    except FileNotFoundError:
        pytest.skip("there is no mount")
    if done.returncode:
        pytest.skip("a small file system cannot be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("extension", [*MESHES, *PICTURES, *TABLES])
def test_a_disk_that_is_full_indeed(big, full_disk, extension):
    path = full_disk / f"old{extension}"
    path.write_bytes(OLD)
    with pytest.raises(OSError, match=r"."):
        save(big, path)
    is_as_it_was(path)


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit, MemoryError])
def test_whatever_ends_the_writing_half_way(target, error):
    def write():
        with written_aside(target) as aside:
            aside.write_bytes(b"a part")
            assert target.read_bytes() == OLD
            raise error

    with pytest.raises(error):
        write()
    is_as_it_was(target)


def calls_while_writing(monkeypatch, at=None):
    """Count the calls from the moment on that a file is there, and raise KeyboardInterrupt at one of them."""
    real, count = os.open, [0]

    def come(frame, event, _):
        if event == "c_call" and frame.f_code.co_name != "__del__":
            count[0] += 1
            if count[0] == at:
                raise KeyboardInterrupt

    def opened(path, *words, **options):
        number = real(path, *words, **options)
        if ".dt3d-" in str(path):
            sys.setprofile(come)
        return number

    monkeypatch.setattr("os.open", opened)
    return count


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # it may come between an open and its `with`
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("target", [*MESHES, ".png", ".csv"], indirect=True)  # pictures have one way
def test_ctrl_c_anywhere_in_each_writer(cube, target, monkeypatch):
    save(cube, target)  # loads what it needs
    target.write_bytes(OLD)
    with monkeypatch.context() as patch:
        count = calls_while_writing(patch)
        save(cube, target)
        sys.setprofile(None)
    whole, target = target, target.with_name("again" + target.suffix)
    size = whole.stat().st_size
    whole.unlink()
    target.write_bytes(OLD)
    # NumPy's tofile, by which meshio writes .msh, gives an interrupt in its midst another name
    ends = (KeyboardInterrupt, TypeError) if target.suffix == ".msh" else KeyboardInterrupt
    moments = sorted({1, 2, 3, *np.linspace(4, count[0] - 8, 8).astype(int)})
    raised = 0
    for at in moments:
        with monkeypatch.context() as patch:
            calls_while_writing(patch, at)
            try:
                save(cube, target)
            except ends:
                raised += 1
            finally:
                sys.setprofile(None)
        if target.stat().st_size == size:  # it came when all was done, or within VTK, which does not hear it
            target.write_bytes(OLD)
        is_as_it_was(target)
    assert raised >= len(moments) - 2


# targets that cannot be written are refused before anything is computed


def refused(path, error, text):
    for check in (check_writable, lambda p: written_aside(p).__enter__()):
        with pytest.raises(error, match=text) as caught:
            check(path)
        assert "\n" not in str(caught.value)


def test_a_folder_in_the_file_s_place(target):
    target.unlink()
    target.mkdir()
    refused(target, IsADirectoryError, "cannot write .*: it is a folder")
    assert target.is_dir()


def test_a_folder_that_is_not_there(target):
    refused(target.parent / "no" / target.name, FileNotFoundError, "cannot write .*there is no folder .*no")
    refused(target / "a.npz", FileNotFoundError, "there is no folder")  # a file in the folder's place
    is_as_it_was(target)


@contextmanager
def somebody_else():
    """An unprivileged user; root may write everywhere."""
    if os.geteuid() != 0:
        yield
        return
    os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(0)


@pytest.fixture
def guarded(target):
    """The file in a folder that others may enter, which pytest's own folders are not."""
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        inner = Path(folder) / "inner"
        inner.mkdir()
        yield Path(target.rename(inner / target.name))
        os.chmod(inner, 0o755)


def test_a_file_that_is_read_only(big, guarded):
    os.chmod(guarded.parent, 0o777)
    os.chmod(guarded, 0o444)
    with somebody_else():
        refused(guarded, PermissionError, "cannot write .*: the file is read-only")
        with pytest.raises(PermissionError):
            save(big, guarded)
    is_as_it_was(guarded)


def test_a_folder_in_which_nothing_may_be_written(big, guarded):
    os.chmod(guarded.parent, 0o555)
    os.chmod(guarded, 0o666)
    with somebody_else():
        refused(guarded, PermissionError, "nothing may be written in its folder.*choose another folder")
        with pytest.raises(PermissionError):
            save(big, guarded)
        refused(guarded.parent / "new.npz", PermissionError, "nothing may be written in its folder")
    is_as_it_was(guarded)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO, errno.EDQUOT])
def test_a_disk_that_fails_only_when_it_is_asked(target, monkeypatch, number):
    def fail(*_):
        raise OSError(number, os.strerror(number))

    for call in ("fsync", "replace"):
        with monkeypatch.context() as patch:
            patch.setattr(os, call, fail)
            with pytest.raises(OSError, match="cannot write .*the old file is as it was"):
                write_csv(target, ["x"], [])
        is_as_it_was(target)


def test_a_file_system_without_fsync_will_do(target, monkeypatch):
    def fail(*_):
        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))

    monkeypatch.setattr(os, "fsync", fail)
    write_csv(target, ["x"], [])
    assert target.read_text() == "x\n"


# what the new file takes over from the old one


def test_permissions_are_those_of_the_old_file_or_of_the_umask(tmp_path):
    path, before = tmp_path / "a.csv", os.umask(0o027)
    try:
        write_csv(path, ["x"], [])
        assert stat.S_IMODE(path.stat().st_mode) == 0o640
        path.chmod(0o604)
        os.utime(path, (1, 1))
        with written_aside(path) as aside:
            assert stat.S_IMODE(aside.stat().st_mode) == 0o600  # nobody else reads it meanwhile
        assert stat.S_IMODE(path.stat().st_mode) == 0o604
        assert path.stat().st_mtime > 1e9
    finally:
        os.umask(before)


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "there").mkdir()
    real, link = tmp_path / "there" / "real.csv", tmp_path / "link.csv"
    link.symlink_to(Path("there") / "real.csv")
    for rows in ([[1]], [[1], [2]]):  # first it dangles
        write_csv(link, ["x"], rows)
        assert link.is_symlink()
        assert real.read_text().split() == ["x", *(str(row[0]) for row in rows)]
    assert os.listdir(real.parent) == ["real.csv"]


def test_a_pipe_and_a_device_stay_what_they_are(tmp_path):
    pipe, got = tmp_path / "pipe.csv", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: got.append(pipe.read_text()))
    reader.start()
    write_csv(pipe, ["x"], [[1]])
    reader.join()
    assert got[0].split() == ["x", "1"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    (tmp_path / "null.npz").symlink_to("/dev/null")
    with written_aside(tmp_path / "null.npz") as path:
        path.write_bytes(b"x")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no such device")
def test_a_device_that_is_full(big, tmp_path):
    for extension in MESHES:
        path = tmp_path / f"full{extension}"
        path.symlink_to("/dev/full")
        with pytest.raises(OSError, match=r".") as caught:
            save(big, path)
        assert caught.value.errno in (errno.ENOSPC, None)
        assert stat.S_ISCHR(os.stat("/dev/full").st_mode)


NOT_TEXT = os.fsdecode(b"\xff.vtu")


@pytest.mark.parametrize("name", ["\u00fc" * 120 + ".npz", NOT_TEXT, "[red]\n$.vtk", "UP.NPZ", "UP.VTU"])
def test_names_that_are_long_or_not_text(tmp_path, cube, name):
    write_mesh(cube, tmp_path / name)
    assert os.listdir(tmp_path) == [name]
    if name != NOT_TEXT:  # VTK opens no such file
        np.testing.assert_array_equal(read_mesh(tmp_path / name).simplices, cube.simplices)


def test_a_ledger_is_written_aside_too(tmp_path):
    machine = sv.Simulated(processors=2)
    sv.scan(machine.vector(np.arange(2000)), sv.ADD)
    path = tmp_path / "steps.csv"
    path.write_bytes(OLD)
    with small_files(10), pytest.raises(OSError, match=r"."):
        machine.ledger.to_csv(path)
    is_as_it_was(path)


# files that are one


def test_files_of_one_command_are_apart(tmp_path):
    a, b, c = tmp_path / "a.npz", tmp_path / "b.npz", tmp_path / "c.npz"
    a.write_bytes(OLD)
    check_apart(b, a)
    b.symlink_to(a)
    os.link(a, c)
    for other in (a, b, c, tmp_path / "." / "a.npz"):
        with pytest.raises(ValueError, match="are one file, which would be replaced; name another file"):
            check_apart(other, a)
    a.unlink()
    with pytest.raises(ValueError, match="would be one file"):
        check_apart(b, a)  # a link to what is not there yet
    check_apart(c, a)

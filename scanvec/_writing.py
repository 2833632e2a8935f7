"""Files that are written aside and renamed: there is a whole new file or the whole old one, never a part.

What is written goes to another name in the same folder, reaches the disk, and then takes the place of the old
file in one step (POSIX ``rename``; T. S. Pillai et al., All file systems are not created equal, OSDI 2014,
has why the ``fsync`` comes before it). A full disk, an exception, Ctrl-C, SIGTERM: the new file is removed
and the old one is as it was. After SIGKILL or a power cut the file aside may be left; its name says of whom.
"""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import signal
import stat
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

ENDING = ("SIGTERM", "SIGHUP")  # what `kill` and a closed terminal send, where the system has them


@contextlib.contextmanager
def written_aside(path: str | Path) -> Iterator[Path]:
    """A path to write to, in the folder and with the extension of ``path``; on success it becomes ``path``.

    The new file has the permissions of the old one, or those that the umask gives. Where ``path`` is a
    symbolic link the file it points to is replaced, and the link stays. What is no file (a pipe, a device)
    has nothing to be kept, and a rename would put a file in its place: it is written to as it is. A hard link
    to the old file, which is another name for it, keeps the old file.

    Raises
    ------
    OSError
        As `check_writable` says, and if the file cannot be written; the old file is then as it was.
    """
    target = check_writable(path)
    old = _status(target)
    try:
        if old is None or stat.S_ISREG(old.st_mode):
            with _aside(target, old) as aside:
                yield aside
        else:
            yield target
    except OSError as error:
        whole = "" if old is None else "; the old file is as it was"
        msg = f"cannot write {path}: {error.strerror or error}{whole}"
        raise (OSError(msg) if error.errno is None else OSError(error.errno, msg)) from error


@contextlib.contextmanager
def _aside(target: Path, old: os.stat_result | None) -> Iterator[Path]:
    aside = target.with_name(f".{target.stem[:40]}.dt3d-{os.getpid()}-{os.urandom(4).hex()}{target.suffix}")
    with _removed_first(aside):
        try:
            # of a file that only some may read no copy lies about that all may read
            os.close(os.open(aside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600 if old else 0o666))
            yield aside
            _to_the_disk(aside)
            if old is not None:
                _like(target, aside, old)
            os.replace(aside, target)
        except BaseException:
            _remove(aside)
            raise


def check_writable(path: str | Path) -> Path:
    """Where writing to ``path`` ends, links followed; to be asked before a long computation, too.

    Raises
    ------
    OSError
        If the folder does not exist or may not be written, or if there is a folder or a read-only file of
        that name.
    """
    path = Path(path)
    target = Path(os.path.realpath(path))
    folder = target.parent
    if not folder.is_dir():
        msg = f"cannot write {path}: there is no folder {folder if path.is_symlink() else path.parent}"
        raise FileNotFoundError(msg)
    old = _status(target)
    if old is not None and stat.S_ISDIR(old.st_mode):
        msg = f"cannot write {path}: it is a folder"
        raise IsADirectoryError(msg)
    if old is not None and not _may_write(target):
        msg = f"cannot write {path}: the file is read-only"
        raise PermissionError(msg)
    if (old is None or stat.S_ISREG(old.st_mode)) and not _may_write(folder):
        msg = (
            f"cannot write {path}: nothing may be written in its folder, and a file is replaced only by a "
            "whole one that was written beside it; choose another folder"
        )
        raise PermissionError(msg)
    return target


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _may_write(path: Path) -> bool:
    wanted = os.W_OK | os.X_OK if path.is_dir() else os.W_OK
    return os.access(path, wanted, effective_ids=os.access in os.supports_effective_ids)


def _to_the_disk(aside: Path) -> None:
    """Some disks say only now that they are full."""
    with aside.open("rb+") as file:
        try:
            os.fsync(file.fileno())
        except OSError as error:
            if error.errno not in (errno.EINVAL, errno.ENOTSUP):  # file systems that do not know of it
                raise


def _like(target: Path, aside: Path, old: os.stat_result) -> None:
    """Give the new file the old one's permissions, and its owner, where we may."""
    if hasattr(os, "chown"):
        with contextlib.suppress(PermissionError):
            os.chown(aside, old.st_uid, old.st_gid)
    with contextlib.suppress(PermissionError):
        shutil.copystat(target, aside)
    os.utime(aside)


def _remove(aside: Path) -> None:
    try:
        aside.unlink(missing_ok=True)
    finally:  # a second Ctrl-C may have come just before
        aside.unlink(missing_ok=True)


@contextlib.contextmanager
def _removed_first(aside: Path) -> Iterator[None]:
    """A signal that ends the process without a word to Python ends it after the file has been removed."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may say what signals do
        return
    numbers = [getattr(signal, name) for name in ENDING if hasattr(signal, name)]
    numbers = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]

    def end(number: int, _: FrameType | None) -> None:
        _remove(aside)
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    try:
        for number in numbers:
            signal.signal(number, end)
        yield
    finally:
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)

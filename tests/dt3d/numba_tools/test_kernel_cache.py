"""Compiled code on disk: never stale, and never in the way.

A package of three small modules is loaded again and again, as new processes would, from one cache.
"""

import ast
import errno
import importlib
import os
import pkgutil
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numba
import pytest
from numba.core import caching

import dt3d
from dt3d._numba import announce, kept, kernel_cache, numba_cache, sources

KERNEL = """
from .kernel_cache import cached_njit
from .inlined import outer

@cached_njit
def kernel(x):
    return outer(x)

@cached_njit(nogil=True, error_model="numpy")
def alone(x):
    return x
"""
INLINED = """
from .kernel_cache import cached_njit
from . import (
    constants,  # (which are compiled in)
)

@cached_njit
def outer(x):
    return constants.SIGN * x
"""


class Package:
    """A package with kernels in a folder of its own; ``load()`` is a new process."""

    def __init__(self, folder):
        self.folder = folder / "kernels_for_tests"
        self.folder.mkdir()
        for module in (announce, kept, kernel_cache, numba_cache, sources):
            shutil.copy(module.__file__, self.folder)
        self.write("__init__", "")
        self.write("kernel", KERNEL)
        self.write("inlined", INLINED)
        self.write("constants", "SIGN = 1\n")

    def write(self, module, text):
        """Change a source; its size and time stay, as an update in place may leave them."""
        file = self.folder / f"{module}.py"
        file.write_text(text)
        os.utime(file, (1e9, 1e9))

    def load(self):
        for name in [name for name in sys.modules if name.partition(".")[0] == self.folder.name]:
            del sys.modules[name]
        for cached in self.folder.glob("__pycache__/*.pyc"):  # Python's own cache goes by time and size
            cached.unlink()
        importlib.invalidate_caches()
        return importlib.import_module(f"{self.folder.name}.kernel")

    def files(self, suffix):
        return sorted((self.folder / "__pycache__").glob(f"kernel.kernel*.{suffix}"))


@pytest.fixture
def package(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    return Package(tmp_path)


def compiled(function):
    return sum(function.stats.cache_misses.values())


def test_unchanged_sources_are_not_compiled_again(package):
    first = package.load().kernel
    assert first(3) == 3
    assert compiled(first) == 1
    again = package.load().kernel
    assert again(3) == 3
    assert compiled(again) == 0


def test_a_constant_changed_in_place_in_another_module_is_seen(package):
    assert package.load().kernel(3) == 3
    package.write("constants", "SIGN = 2\n")
    assert package.load().kernel(3) == 6


def test_a_function_changed_in_place_in_another_module_is_seen(package):
    assert package.load().kernel(3) == 3
    package.write("inlined", INLINED.replace("SIGN * x", "SIGN - x"))
    module = package.load()
    assert module.kernel(3) == -2
    assert module.alone(3) == 3


def test_a_module_that_no_kernel_imports_makes_nothing_stale(package):
    package.load().kernel(3)
    package.write("other", "SIGN = 2\n")
    again = package.load().kernel
    again(3)
    assert compiled(again) == 0


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", ["empty", "cut", "garbled", "flipped"])
def test_a_damaged_file_is_compiled_again_and_mended(package, suffix, damage):
    package.load().kernel(3)
    (file,) = package.files(suffix)
    whole = file.read_bytes()
    middle = len(whole) // 2
    file.write_bytes({
        "empty": b"",
        "cut": whole[:middle],
        "garbled": bytes(range(256)),
        "flipped": whole[:middle] + bytes([whole[middle] ^ 255]) + whole[middle + 1 :],
    }[damage])  # fmt: skip
    assert package.load().kernel(3) == 3
    again = package.load().kernel
    assert again(3) == 3
    assert compiled(again) == 0


def test_code_under_the_name_of_another_is_not_run(package):
    """As two processes leave it that save different types at once."""
    package.load().kernel(3)
    (integers,) = package.files("nbc")
    foreign = integers.read_bytes()
    package.load().kernel(2.5)
    (floats,) = set(package.files("nbc")) - {integers}
    floats.write_bytes(foreign)
    again = package.load().kernel
    assert again(2.5) == 2.5
    assert compiled(again) == 1


def test_code_of_an_older_version_that_still_runs_is_not_run(package):
    """A process that began before an update saves what it compiles under the same name."""
    package.load().kernel(3)
    (file,) = package.files("nbc")
    old = file.read_bytes()
    package.write("constants", "SIGN = 2\n")
    assert package.load().kernel(3) == 6
    (file,) = package.files("nbc")
    file.write_bytes(old)
    assert package.load().kernel(3) == 6


def test_a_full_disk_does_not_end_the_call_and_is_said_once(package, monkeypatch, caplog):
    module = package.load()

    def full(self, overloads):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(caching.IndexDataCacheFile, "_save_index", full)
    assert module.kernel(3) == 3
    assert module.kernel(2.5) == 2.5
    (record,) = caplog.records
    assert record.name == "dt3d"
    assert "No space left on device" in record.getMessage()
    assert "NUMBA_CACHE_DIR" in record.getMessage()


def not_writable(monkeypatch):
    """Folders that cannot be written; permissions do not stop the root of a container."""

    def refuse(**options):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(caching.tempfile, "TemporaryFile", refuse)


def test_without_a_writable_folder_it_works(package, monkeypatch):
    monkeypatch.setattr(caching.AppDirs, "user_cache_dir", "/dev/null/nowhere")
    (package.folder / "__pycache__").write_text("a file in place of the folder")
    module = package.load()
    assert module.kernel(3) == 3
    assert not sys.modules[f"{package.folder.name}.kept"].Kept.anywhere


def test_a_folder_that_was_filled_and_cannot_be_written_serves(package, monkeypatch):
    package.load().kernel(3)
    not_writable(monkeypatch)
    again = package.load().kernel
    assert again(3) == 3
    assert compiled(again) == 0


def test_the_cure_serves(package, monkeypatch, tmp_path):
    """NUMBA_CACHE_DIR, as the messages advise; also where the package is in a zip file."""
    monkeypatch.setattr(caching.AppDirs, "user_cache_dir", "/dev/null/nowhere")
    (package.folder / "__pycache__").write_text("a file in place of the folder")
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "chosen"))
    package.load().kernel(3)
    again = package.load().kernel
    again(3)
    assert compiled(again) == 0


def test_a_package_in_a_zip_file(package, monkeypatch, tmp_path, caplog):
    archive = tmp_path / "all.zip"

    def pack():
        with zipfile.ZipFile(archive, "w") as file:
            for source in package.folder.glob("*.py"):
                file.write(source, f"{package.folder.name}/{source.name}")

    pack()
    monkeypatch.setattr(sys, "path", [str(archive), *sys.path])
    monkeypatch.setattr(caching.AppDirs, "user_cache_dir", "/dev/null/nowhere")
    assert package.load().kernel(3) == 3
    (record,) = caplog.records
    assert "NUMBA_CACHE_DIR" in record.getMessage()
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "chosen"))
    package.load().kernel(3)
    again = package.load().kernel
    assert again(3) == 3
    assert ".zip" in again.py_func.__code__.co_filename
    assert compiled(again) == 0
    package.write("constants", "SIGN = 2\n")
    pack()
    sys.path_importer_cache.pop(str(archive), None)
    assert package.load().kernel(3) == 6


TWO = """
import sys
from kernels_for_tests.kernel import kernel, alone
print("ready", flush=True)
sys.stdin.readline()
print(kernel(3), kernel(2.5), alone(3), sum(sum(f.stats.cache_misses.values()) for f in (kernel, alone)))
"""


def test_two_first_processes_at_once_and_a_third_that_compiles_nothing(package, tmp_path):
    def start():
        return subprocess.Popen(
            [sys.executable, "-c", TWO], cwd=tmp_path, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip

    def end(process):
        out, err = process.communicate("\n")
        assert not err
        return out.split()[-4:]

    both = [start(), start()]
    for process in both:
        process.stdout.readline()
    for process in both:  # both compile before either is waited for
        process.stdin.write("\n")
        process.stdin.flush()
    assert [end(process)[:3] for process in both] == [["3", "2.5", "3"]] * 2
    assert end(start()) == ["3", "2.5", "3", "0"]


def test_this_numba_has_what_the_cache_is_made_from():
    assert kernel_cache.source_cache() is not None, (
        f"numba {numba.__version__} caches in another form: compiled code can be stale after an update in "
        f"place, and a damaged cache ends a call; adapt dt3d/_numba/numba_cache.py"
    )


def test_a_numba_that_caches_in_another_form_does_it_its_own_way(package, monkeypatch):
    monkeypatch.delattr(caching, "ZipCacheLocator")  # which older ones lack
    function = package.load().kernel
    assert function(3) == 3
    assert type(function._cache) is caching.FunctionCache


def modules_with_kernels():
    names = [m.name for m in pkgutil.walk_packages(dt3d.__path__, "dt3d.")]
    files = {name: Path(importlib.util.find_spec(name).origin) for name in names if "__main__" not in name}
    return [name for name, file in files.items() if "njit" in file.read_text()]


def test_imports_are_those_that_python_finds():
    for name in modules_with_kernels():
        module = importlib.import_module(name)
        source = Path(module.__file__).read_text()
        expected = set()
        for node in ast.parse(source).body:
            if isinstance(node, ast.Import):
                expected.update(alias.name for alias in node.names)
            if isinstance(node, ast.ImportFrom):
                base = importlib.util.resolve_name("." * node.level + (node.module or ""), module.__package__)
                inside = {f"{base}.{alias.name}" for alias in node.names}
                expected |= inside & sys.modules.keys()
                if inside - sys.modules.keys():
                    expected.add(base)
        expected = {m for m in expected if m.partition(".")[0] == "dt3d"}
        assert sources.imported(source, name, hasattr(module, "__path__")) == expected, name


def test_what_kernels_use_is_among_their_sources():
    for name in modules_with_kernels():
        module = importlib.import_module(name)
        found = closure(name)
        for function in vars(module).values():
            if not hasattr(function, "py_func"):
                continue
            for used in function.py_func.__code__.co_names:
                value = module.__dict__.get(used)
                home = getattr(getattr(value, "py_func", value), "__module__", None)
                if isinstance(home, str) and home.startswith("dt3d."):
                    assert home in found, f"{name}: {used} is of {home}"


def closure(module):
    found, ahead = set(), {module}
    while ahead:
        found |= ahead
        ahead = set().union(*(sources._read(name)[1] for name in ahead)) - found
    return found

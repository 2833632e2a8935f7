"""What compiled code was made from: the module of a kernel, and all that it imports from its package.

numba compiles functions of other modules, and constants, into the code that uses them. So machine code on
disk is stale as soon as one of these sources has changed, not only that of the kernel itself.
"""

from __future__ import annotations

import hashlib
import re
import sys
from functools import cache

# At the beginning of a line: `from .a import b, c`, also in parentheses, and `import package.a as b`. What is
# imported later, inside a function or for type checkers, is not compiled in.
_FROM = re.compile(r"^from[ \t]+([.\w]+)[ \t]+import[ \t]*(\([^)]*\)|[^\n]*)", re.MULTILINE)
_IMPORT = re.compile(r"^import[ \t]+([^\n#]+)", re.MULTILINE)
_NAME = re.compile(r"(\w+)(?:\s+as\s+\w+)?\s*(?:,|\)|#|$)")


def fingerprint(module: str) -> str | None:
    """Return a hash over the sources of a module and of all that it imports from its own package, in turn.

    The dotted ``module`` must have been imported, or have got beyond its imports. None where no source is at
    hand, as in a frozen program.
    """
    found: dict[str, str] = {}
    ahead = {module}
    while ahead:
        name = ahead.pop()
        digest, imports = _read(name)
        if digest is None:
            return None
        found[name] = digest
        ahead |= imports - found.keys()
    return hashlib.sha256(repr(sorted(found.items())).encode()).hexdigest()


@cache
def _read(module: str) -> tuple[str | None, frozenset[str]]:
    """A hash over the source of a module, and what it imports from its own package."""
    loader: object = getattr(sys.modules[module], "__loader__", None)
    try:
        source: str | None = loader.get_source(module)  # type: ignore[attr-defined]  # from a zip file, too
    except (AttributeError, ImportError):  # no loader, or one that has no source
        source = None
    if source is None:
        return None, frozenset()
    is_package = hasattr(sys.modules[module], "__path__")
    return hashlib.sha256(source.encode()).hexdigest(), imported(source, module, is_package)


def imported(source: str, module: str, is_package: bool) -> frozenset[str]:
    """The dotted names of the loaded modules of its own package that a source imports.

    Only imports at the beginning of a line count.
    """
    names: set[str] = set()
    for origin, what in _FROM.findall(source):
        base = _absolute(origin, module, is_package)
        inside = {f"{base}.{name}" for name in _NAME.findall(what)}
        submodules = inside & sys.modules.keys()
        names |= submodules
        if submodules != inside:
            names.add(base)
    for line in _IMPORT.findall(source):
        names.update(part.split()[0] for part in line.split(",") if part.split())
    root = module.partition(".")[0]
    return frozenset(name for name in names & sys.modules.keys() if name.partition(".")[0] == root)


def _absolute(origin: str, module: str, is_package: bool) -> str:
    """The dotted name of what a `from` in a module names."""
    name = origin.lstrip(".")
    up = len(origin) - len(name)
    if not up:
        return name
    parts = module.split(".")
    parts = parts[: len(parts) - up + is_package]
    return ".".join([*parts, name] if name else parts)

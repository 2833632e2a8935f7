"""Functions of Python that XLA calls as foreign ones, on CPUs, with the memory of its own arrays.

XLA's interface for foreign functions passes a frame of pointers: to the arrays that are there, and to those
that are to be filled. So nothing is copied, where a callback's results are. The structures here are those of
``xla/ffi/api/c_api.h``, which comes with jaxlib; each begins with its size, and XLA only ever adds fields at
their ends. What a function raises becomes the error of the program, in its words.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import POINTER, Structure, c_char_p, c_int, c_int64, c_size_t, c_uint32, c_void_p
from functools import cache
from typing import TYPE_CHECKING, Any, cast

import jax
import numpy as np

if TYPE_CHECKING:
    from .host import Arrays

    Filler = Callable[[Arrays, Arrays], None]  # of what is given, and of what is to be filled

MAJOR_VERSION = 0  # of the interface: another one may have other structures
METADATA = 1  # the extension by which XLA asks a handler for its version
EXECUTE = 3  # the stage in which a handler is to do its work
INVALID_ARGUMENT, CANCELLED = 3, 1  # codes of errors
DTYPES = {4: np.int32, 5: np.int64, 11: np.float32, 12: np.float64}  # those of our arrays
READ, WRITE = 0x100, 0x200  # PyBUF_READ, PyBUF_WRITE


class _Extension(Structure):
    _fields_ = [("size", c_size_t), ("type", c_int), ("next", c_void_p)]


class _Version(Structure):
    _fields_ = [("size", c_size_t), ("extensions", c_void_p), ("major", c_int), ("minor", c_int)]


class _Metadata(Structure):
    _fields_ = [("size", c_size_t), ("version", _Version), ("traits", c_uint32)]


class _MetadataExtension(Structure):
    _fields_ = [("base", _Extension), ("metadata", POINTER(_Metadata))]


class _Buffer(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("extensions", c_void_p),
        ("dtype", c_int),
        ("data", c_void_p),
        ("rank", c_int64),
        ("dims", POINTER(c_int64)),
    ]


class _Buffers(Structure):
    """Of arguments or of results; each of a type, of which there is one."""

    _fields_ = [
        ("size", c_size_t),
        ("extensions", c_void_p),
        ("count", c_int64),
        ("types", c_void_p),
        ("buffers", POINTER(POINTER(_Buffer))),
    ]


class _Error(Structure):
    _fields_ = [("size", c_size_t), ("extensions", c_void_p), ("message", c_char_p), ("code", c_int)]


class _Api(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("extensions", c_void_p),
        ("version", _Version),
        ("internal", c_void_p),
        ("create_error", ctypes.CFUNCTYPE(c_void_p, POINTER(_Error))),
    ]


class _Frame(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("extensions", POINTER(_Extension)),
        ("api", POINTER(_Api)),
        ("context", c_void_p),
        ("stage", c_int),
        ("arguments", _Buffers),
        ("results", _Buffers),
    ]


_HANDLER = ctypes.CFUNCTYPE(c_void_p, POINTER(_Frame))
# a function of our own, since what is declared of that of ctypes is declared for all
_memory_at = ctypes.PYFUNCTYPE(ctypes.py_object, c_void_p, ctypes.c_ssize_t, c_int)(
    ("PyMemoryView_FromMemory", ctypes.pythonapi)
)
_handlers: list[Any] = []  # which XLA may call as long as the process runs


@cache
def target_of(fill: Filler) -> str:
    """The name by which compiled programs call ``fill``, a function of a module, on CPUs."""
    name = f"{fill.__module__}.{fill.__qualname__}"

    def handle(pointer: Any) -> int | None:
        frame = pointer.contents
        try:
            if frame.extensions and frame.extensions.contents.type == METADATA:
                _answer(frame)
            elif frame.stage == EXECUTE:
                fill(_arrays(frame.arguments, READ), _arrays(frame.results, WRITE))
        except Exception as error:  # the program ends with it
            return _error(frame, f"{type(error).__name__}: {error}", INVALID_ARGUMENT)
        except BaseException as error:  # Ctrl-C, where XLA calls in the main thread
            return _error(frame, type(error).__name__, CANCELLED)
        return None

    handler = _HANDLER(handle)
    _handlers.append(handler)
    jax.ffi.register_ffi_target(name, jax.ffi.pycapsule(handler), platform="cpu")
    return name


def _answer(frame: Any) -> None:
    """Say of which version of the interface this handler is: of that which calls."""
    extension = ctypes.cast(frame.extensions, POINTER(_MetadataExtension)).contents
    version, theirs = extension.metadata.contents.version, frame.api.contents.version
    version.major, version.minor = MAJOR_VERSION, theirs.minor
    extension.metadata.contents.traits = 0


def _arrays(buffers: Any, access: int) -> list[np.ndarray]:
    """Arrays of NumPy in XLA's memory, which are there as long as the call."""
    return [_array(buffers.buffers[i].contents, access) for i in range(buffers.count)]


def _array(buffer: Any, access: int) -> np.ndarray:
    shape = buffer.dims[: buffer.rank]
    dtype = np.dtype(DTYPES[buffer.dtype])
    size = dtype.itemsize * int(np.prod(shape))
    if not size:
        return np.empty(shape, dtype)
    return np.frombuffer(cast(memoryview, _memory_at(buffer.data, size, access)), dtype).reshape(shape)


def _error(frame: Any, message: str, code: int) -> int | None:
    """An error of XLA's, which then owns it."""
    error = _Error(ctypes.sizeof(_Error), None, message.encode(), code)
    return cast("int | None", frame.api.contents.create_error(ctypes.byref(error)))

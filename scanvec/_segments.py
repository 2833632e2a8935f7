"""Segments: how a vector is divided into consecutive parts."""

from __future__ import annotations

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

from ._checks import LARGEST_VECTOR, check_flags
from ._machine.base import Machine
from ._monoid import ADD, MAX, MIN, UNIQUE
from ._vector import Vector


@dataclass(frozen=True)
class Segments:
    """m consecutive segments of a vector of n elements; some may be empty.

    Three descriptions of one thing (Blelloch 1990, section 4.2): head flags, lengths, ids. Make one with
    `from_lengths`, `from_flags` or `from_ids`, or get it from `scanvec.distribute`.

    Attributes
    ----------
    heads : Vector of bool, length n
        Set at the first element of each segment that is not empty.
    ids : Vector of int32, length n
        The number of the segment of each element.
    lengths, starts : Vector of int32, length m
        Elements in each segment, and the index of its first one.

    Examples
    --------
    >>> import scanvec as sv
    >>> device = sv.Device()
    >>> segments = sv.Segments.from_lengths(device.vector([3, 2]))
    >>> v = device.vector([5, 1, 3, 4, 3])
    >>> sv.reduce(v, sv.ADD, segments)
    Vector([9 7], dtype=int64, Device())
    """

    heads: Vector
    ids: Vector
    lengths: Vector
    starts: Vector

    @property
    def machine(self) -> Machine:
        """Where the vectors live.

        Examples
        --------
        >>> import scanvec as sv
        >>> sv.Segments.from_lengths(sv.Device().vector([3, 2])).machine
        Device()
        """
        return self.heads.machine

    @property
    def count(self) -> int:
        """m, the number of segments.

        >>> import scanvec as sv
        >>> segments = sv.Segments.from_lengths(sv.Device().vector([3, 0, 2]))
        >>> segments.count
        3
        """
        return len(self.lengths)

    @property
    def offsets(self) -> Vector:
        """r[i] = i minus the start of i's segment, int32. Three steps.

        >>> import scanvec as sv
        >>> segments = sv.Segments.from_lengths(sv.Device().vector([3, 0, 2]))
        >>> segments.offsets
        Vector([0 1 2 0 1], dtype=int32, Device())
        """
        machine = self.machine
        return machine.iota(len(self.ids)) - machine.get(self.starts, self.ids)

    @classmethod
    def from_lengths(cls, lengths: Vector) -> Segments:
        """Segments of the given lengths, 0 allowed. Eleven steps over n and m elements.

        Raises
        ------
        ValueError
            If a length is negative, or they add up to more than 2^31 - 1.
        TypeError
            If the lengths are not integers.

        Examples
        --------
        >>> import scanvec as sv
        >>> segments = sv.Segments.from_lengths(sv.Device().vector([3, 0, 2]))
        >>> segments.ids
        Vector([0 0 0 2 2], dtype=int32, Device())
        """
        machine = lengths.machine
        if lengths.dtype.kind not in "iu":
            msg = f"segment lengths must be integers, got {lengths.dtype}"
            raise TypeError(msg)
        m = len(lengths)
        if not m:
            empty = machine.full(0, 0, np.int32)
            return cls(machine.full(0, False, bool), empty, empty, empty)
        # in 64 bits and cut off above the largest vector, so that too great a total is seen
        wide = machine.map(_wide, lengths)
        least = machine.item(machine.scan(wide, MIN, exclusive=False), -1)
        if least < 0:
            msg = f"segment lengths must not be negative, got {least}"
            raise ValueError(msg)
        ends = machine.scan(wide, ADD, exclusive=False)
        n = int(machine.item(ends, -1))
        if n > LARGEST_VECTOR:
            msg = f"the segments hold {n} elements or more; a vector takes at most 2^31 - 1"
            raise ValueError(msg)
        lengths = lengths.astype(np.int32)
        starts = ends.astype(np.int32) - lengths
        marks = machine.full(n, -1, np.int32)
        if n:
            marks = machine.send(machine.iota(m), starts, UNIQUE, into=marks, where=lengths > 0)
        return cls(marks >= 0, machine.scan(marks, MAX, exclusive=False), lengths, starts)

    @classmethod
    def from_flags(cls, heads: Vector) -> Segments:
        """Segments that begin where a flag is set; the first element begins one in any case. Eight steps.

        Raises
        ------
        TypeError
            If the flags are not booleans.

        Examples
        --------
        >>> import scanvec as sv
        >>> heads = sv.Device().vector([True, False, False, True])
        >>> sv.Segments.from_flags(heads).lengths
        Vector([3 1], dtype=int32, Device())
        """
        check_flags(heads, "head flags")
        machine = heads.machine
        n = len(heads)
        if not n:
            return cls.from_lengths(machine.full(0, 0, np.int32))
        index = machine.iota(n)
        heads = heads | (index == 0)
        ids = machine.scan(heads, ADD, exclusive=False) - 1
        m = int(machine.item(ids, -1)) + 1
        zeros = machine.full(m, 0, np.int32)
        starts = machine.send(index, ids, UNIQUE, into=zeros, where=heads)
        ones = machine.full(n, 1, np.int32)
        return cls(heads, ids, machine.send(ones, ids, ADD, into=zeros), starts)

    @classmethod
    def from_ids(cls, ids: Vector) -> Segments:
        """Segments of equal consecutive ids; they are numbered anew from 0. Thirteen steps.

        >>> import scanvec as sv
        >>> ids = sv.Device().vector([7, 7, 7, 2])
        >>> sv.Segments.from_ids(ids).lengths
        Vector([3 1], dtype=int32, Device())
        """
        machine = ids.machine
        n = len(ids)
        if not n:
            return cls.from_flags(machine.full(0, False, bool))
        index = machine.iota(n)
        before = machine.get(ids, index - 1, where=index > 0, otherwise=0)
        return cls.from_flags(ids != before)


def _wide(length: jax.Array) -> jax.Array:
    too_long = length > min(LARGEST_VECTOR, int(np.iinfo(length.dtype).max))
    return jnp.where(too_long, LARGEST_VECTOR + 1, length.astype(jnp.int64))

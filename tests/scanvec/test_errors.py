"""What scanvec raises: the texts say what came, what was expected, and what to do."""

import re

import jax.numpy as jnp
import numpy as np
import pytest

import scanvec as sv

from .cases import MACHINES

M, OTHER = MACHINES[3], MACHINES[0]
INTS = M.vector(np.array([4, 5, 6], np.int32))
FLOATS = M.vector([0.5, 1.5, 2.5])
FLAGS = M.vector([True, False, True])
LONGER = M.vector([0, 1, 2, 3])
NOTHING = M.vector(np.zeros(0))
ELSEWHERE = OTHER.vector([0, 1, 2])
SEGMENTS = sv.Segments.from_lengths(M.vector([2, 2]))
MINE = sv.Monoid("mine", jnp.add, lambda dtype: 0)


def two_of(x):
    return jnp.stack([x, x])


def rotated(x):
    return x * 1j


def twice(x):
    return x, x


CASES = [
    # machines and vectors
    (lambda: sv.Simulated(processors=0), ValueError, "processors must be a positive integer, got 0"),
    (lambda: sv.Simulated(processors=2.5), ValueError, "processors must be a positive integer, got 2.5"),
    (lambda: sv.Simulated(processors=True), ValueError, "processors must be a positive integer, got True"),
    (lambda: M.vector([[1, 2]]), ValueError, "a vector takes a one-dimensional array, got shape (1, 2); use"),
    (lambda: M.vector(3), ValueError, "a vector takes a one-dimensional array, got shape ()"),
    (lambda: M.vector([1j]), TypeError, "elements of at most 64 bits, got complex128"),
    (lambda: M.vector(["a"]), TypeError, "a vector takes bool, int, uint or float elements"),
    (lambda: M.vector([0], np.longdouble), TypeError, f"got {np.dtype(np.longdouble)}"),
    (lambda: M.full(3, 0, complex), TypeError, "got complex128"),
    (lambda: M.full(-1, 0, int), ValueError, "a vector takes 0 .. 2^31 - 1 elements, got -1"),
    (lambda: M.iota(2**31), ValueError, "a vector takes 0 .. 2^31 - 1 elements, got 2147483648"),
    (lambda: OTHER.iota(-3), ValueError, "a vector takes 0 .. 2^31 - 1 elements, got -3"),
    (lambda: M.item(INTS, 3), IndexError, "index 3 is out of range for a vector of 3 elements"),
    (lambda: M.item(INTS, -4), IndexError, "index -4 is out of range"),
    (lambda: M.item(NOTHING, 0), IndexError, "index 0 is out of range for a vector of 0 elements"),
    (lambda: bool(INTS == INTS), ValueError, "the truth of a Vector is ambiguous; use scanvec.reduce(v,"),
    (lambda: hash(INTS), TypeError, "unhashable type: 'Vector'"),
    # vectors that do not go together
    (lambda: INTS + LONGER, ValueError, "vectors have different lengths: 3 and 4"),
    (lambda: INTS + ELSEWHERE, ValueError, "Simulated(processors=4) and Device(); move one through to_numpy"),
    (lambda: sv.scan((INTS, LONGER), sv.ARGMIN), ValueError, "vectors have different lengths: 3 and 4"),
    (lambda: sv.scan(np.arange(3), sv.ADD), TypeError, "of Vectors, got ndarray; use machine.vector(array)"),
    (lambda: sv.scan((INTS, 1.0), sv.ARGMIN), TypeError, "of Vectors, got Vector, float"),
    (lambda: sv.get((), INTS), TypeError, "of Vectors, got nothing"),
    # map
    (lambda: M.map(abs, 3), TypeError, "map needs at least one Vector among its arguments"),
    (lambda: M.map(abs, 3, where=FLAGS, otherwise=INTS), TypeError, "map needs at least one Vector"),
    (lambda: INTS + np.arange(3), TypeError, "map takes Vectors and scalars, got an array of shape (3,)"),
    (lambda: M.map(two_of, INTS), TypeError, "map: two_of returned shape (2,) for one element; it must"),
    (lambda: M.map(rotated, FLOATS), TypeError, "map: rotated returned a complex number; return a record"),
    (lambda: M.map(abs, INTS, where=FLAGS), TypeError, "map under a context needs `otherwise`"),
    (lambda: M.map(abs, INTS, where=INTS, otherwise=0), TypeError, "map: where must be a Vector of bool,"),
    (lambda: M.map(abs, INTS, where=True, otherwise=0), TypeError, "map: where must be a Vector of bool,"),
    (lambda: M.map(abs, LONGER, where=FLAGS, otherwise=0), ValueError, "vectors have different lengths: 4"),
    (lambda: M.map(twice, INTS, where=FLAGS, otherwise=(1, 2, 3)), TypeError, "give one like the result or"),
    # scans
    (lambda: sv.scan(FLOATS, sv.AND), TypeError, "scan: the operator and is not defined for float64"),
    (lambda: sv.scan((INTS, FLOATS), sv.OR), TypeError, "scan: the operator or is not defined for float64"),
    (lambda: sv.reduce(NOTHING, sv.OR), TypeError, "reduce: the operator or is not defined for float64"),
    (lambda: sv.scan(INTS, sv.ADD, SEGMENTS), ValueError, "the segments describe 4 elements, the vector has"),
    (lambda: sv.reduce(NOTHING, sv.ADD, SEGMENTS), ValueError, "the segments describe 4 elements, the"),
    (lambda: sv.segmented_sort(INTS, SEGMENTS), ValueError, "the segments describe 4 elements, the vector"),
    (lambda: M.scan(INTS, sv.ADD, exclusive=True, heads=INTS), TypeError, "scan: heads must be a Vector of"),
    (lambda: sv.enumerate(INTS), TypeError, "enumerate: the flags must be a Vector of bool, got int32"),
    # get
    (lambda: sv.get(INTS, INTS), IndexError, "get: indices from 4 to 6, but the vector has 3 elements (0 .."),
    (lambda: sv.get(INTS, INTS - 5), IndexError, "get: indices from -1 to 1, but"),
    (lambda: sv.get(NOTHING, M.vector([0])), IndexError, "but the vector has 0 elements (no index)"),
    (lambda: sv.get(INTS, M.vector(np.array([2**64 - 1], np.uint64))), IndexError, "get: indices from"),
    (lambda: sv.get(INTS, FLOATS), TypeError, "get: the index must be a Vector of integers, got float64"),
    (lambda: sv.get(INTS, FLAGS), TypeError, "get: the index must be a Vector of integers, got bool"),
    (lambda: sv.get(INTS, [0]), TypeError, "get: the index must be a Vector of integers, got list"),
    (lambda: sv.get(INTS, ELSEWHERE), ValueError, "get: the index lives on Device(), the vector on"),
    (lambda: sv.get(INTS, INTS, where=INTS, otherwise=0), TypeError, "get: where must be a Vector of bool,"),
    (lambda: sv.get(INTS, LONGER, where=FLAGS, otherwise=0), ValueError, "vectors have different lengths: 4"),
    # send and permute
    (lambda: sv.send(INTS, INTS, sv.ADD, into=INTS), IndexError, "send: indices from 4 to 6, but the vector"),
    (lambda: sv.send(INTS, FLOATS, sv.ADD, into=INTS), TypeError, "send: the index must be a Vector of"),
    (lambda: sv.send(INTS, LONGER, sv.ADD, into=INTS), ValueError, "vectors have different lengths: 3 and 4"),
    (lambda: sv.send(INTS, INTS, sv.ADD, into=ELSEWHERE), ValueError, "vectors live on different machines"),
    (lambda: sv.send(INTS, INTS, sv.ADD, into=FLOATS), ValueError, "send: elements of int32 cannot go into"),
    (lambda: sv.send((INTS, INTS), INTS, sv.ADD, into=[INTS, INTS]), ValueError, "send: a record"),
    (lambda: sv.send(FLAGS, INTS, sv.ADD, into=FLAGS), TypeError, "send: the operator add is not defined"),
    (lambda: sv.send(INTS, INTS - 4, MINE, into=INTS), TypeError, "send: the operator mine cannot combine a"),
    (lambda: sv.send(INTS, INTS, sv.ADD, into=INTS, where=INTS), TypeError, "send: where must be a Vector"),
    (lambda: sv.permute(INTS, M.vector([1, 2, 1])), ValueError, "permute: 2 elements are sent to position"),
    (lambda: sv.permute(INTS, M.vector([0, 1, 3])), IndexError, "indices from 0 to 3, but the vector has 3"),
    (lambda: sv.permute(INTS, LONGER), ValueError, "vectors have different lengths: 3 and 4"),
    (lambda: sv.scatter(INTS, INTS * 0, into=INTS), ValueError, "scatter: 3 elements are sent to position 0"),
    (lambda: sv.scatter(INTS, INTS, into=INTS), IndexError, "indices from 4 to 6, but the vector has 3"),
    (lambda: sv.scatter(INTS, INTS, into=FLOATS), ValueError, "scatter: elements of int32 cannot go into"),
    # what is composed
    (lambda: sv.pack(INTS, INTS), TypeError, "the flags must be a Vector of bool, got int32"),
    (lambda: sv.pack(LONGER, FLAGS), ValueError, "vectors have different lengths: 4 and 3"),
    (lambda: sv.split(INTS, [True]), TypeError, "the flags must be a Vector of bool, got list"),
    (lambda: sv.append(INTS, (INTS,)), ValueError, "append: the two records have different structures"),
    (lambda: sv.append(INTS, FLOATS), ValueError, "append: the two records have different dtypes; convert"),
    (lambda: sv.append(FLOATS, M.vector(np.zeros(0, int))), ValueError, "append: the two records have"),
    (lambda: sv.append(INTS, ELSEWHERE), ValueError, "vectors live on different machines"),
    (lambda: sv.distribute(INTS, LONGER), ValueError, "distribute: 3 elements, but 4 counts"),
    (lambda: sv.distribute(INTS, INTS - 5), ValueError, "segment lengths must not be negative, got -1"),
    (lambda: sv.distribute(INTS, FLOATS), TypeError, "segment lengths must be integers, got float64"),
    (lambda: sv.sort(INTS, LONGER), ValueError, "sort: 3 keys, but a payload of 4"),
    (lambda: sv.Segments.from_flags(INTS), TypeError, "head flags must be a Vector of bool, got int32"),
]  # fmt: skip


@pytest.mark.parametrize(("program", "error", "text"), CASES, ids=[text[:40] for _, _, text in CASES])
def test_errors(program, error, text):
    with pytest.raises(error, match=re.escape(text)):
        program()


CURES = [
    (lambda: sv.scan(FLOATS, sv.AND), "convert the vector first, for example with v.astype('int32')"),
    (
        lambda: sv.send(INTS, INTS - 4, MINE, into=INTS),
        "use one of scanvec's ADD, MUL, MIN, MAX, AND, OR, COPY",
    ),
    (lambda: sv.permute(INTS, INTS * 0), "For a concurrent write use scanvec.send with a combining operator"),
    (lambda: bool(FLAGS), "use scanvec.reduce(v, scanvec.OR) or scanvec.AND"),
    (lambda: M.map(abs, INTS, where=FLAGS), "`otherwise`: what elements outside the context get"),
    (
        lambda: M.get(INTS, INTS, where=FLAGS, otherwise=None),
        "`otherwise`: what elements outside the context get",
    ),
    (lambda: sv.append(INTS, FLOATS), "convert with astype"),
]


@pytest.mark.parametrize(("program", "text"), CURES)
def test_the_text_ends_in_what_to_do(program, text):
    with pytest.raises((TypeError, ValueError), match=re.escape(text) + "$"):
        program()


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_a_repeated_index_is_found_on_every_machine(machine):
    index = np.arange(100)
    index[[7, 55, 99]] = 42  # where vectors lie on processors in different places
    with pytest.raises(ValueError, match="permute: 4 elements are sent to position 42"):
        sv.permute(machine.iota(100), machine.vector(index))


def test_a_user_defined_operator_may_have_any_name():
    # the name alone must not make it one of those that send knows
    with pytest.raises(TypeError, match="the operator min cannot combine"):
        sv.send(INTS, INTS - 4, sv.Monoid("min", jnp.add, lambda dtype: 0), into=INTS)


def test_get_takes_a_scalar_for_what_is_outside_the_context():
    machine = MACHINES[0]
    v = machine.vector([1, 2, 3])
    with pytest.raises(TypeError, match="`otherwise` must be a scalar, got Vector"):
        sv.get(v, machine.iota(3), where=v > 1, otherwise=v)

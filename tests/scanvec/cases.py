"""What the tests run over: machines, dtypes, and hypothesis strategies for vectors and segments.

The machines are shared by all tests, and drawn vectors are shorter than 4096 elements, so that the kernels,
which cost more than the tests, are compiled once.
"""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import jax
import numpy as np

import scanvec as sv

MACHINES = (sv.Device(), *(sv.Simulated(processors=p) for p in (1, 3, 4, 32)))

INTEGERS = tuple(f"{kind}{bits}" for kind in ("int", "uint") for bits in (8, 16, 32, 64))
FLOATS = ("float16", "float32", "float64")
DTYPES = ("bool", *INTEGERS, *FLOATS)

lengths_of_segments = st.lists(st.integers(0, 6), max_size=12)  # empty and one-element segments among them
sizes = st.one_of(st.sampled_from([0, 1, 2, 3, 4, 5, 31, 32, 33, 64, 100]), st.integers(0, 70))


def words(n: int | st.SearchStrategy[int]) -> st.SearchStrategy[np.ndarray]:
    """Raw 64-bit words, from which `of_dtype` makes elements of every dtype."""
    return hnp.arrays(np.uint64, n, elements=st.integers(0, 2**64 - 1))


def of_dtype(raw: np.ndarray, dtype: str) -> np.ndarray:
    """One element of ``dtype`` from the low bits of each word: any value but subnormal numbers.

    XLA takes those for zero on CPUs, and `test_sort` has them; small words give small numbers instead.
    """
    wanted = np.dtype(dtype)
    if wanted.kind == "b":
        return raw % 2 == 1
    bits = raw.astype(f"uint{8 * wanted.itemsize}")
    out = bits.view(wanted)
    if wanted.kind == "f":
        small = ((raw % 251).astype(np.int64) - 125).astype(wanted)
        out = np.where(np.abs(out) < np.finfo(wanted).tiny, small, out)
    return out


def of_dtypes(raw: np.ndarray, dtypes: tuple[str, ...] = DTYPES) -> dict[str, np.ndarray]:
    """A record with one array of each dtype."""
    return {dtype: of_dtype(raw, dtype) for dtype in dtypes}


def load(machine: sv.Machine, record: object) -> object:
    """The record with its arrays on the machine."""
    return jax.tree.map(machine.vector, record)


def assert_same(got: object, want: np.ndarray) -> None:
    """The vector has the dtype, the length and the bits of the array; any NaN equals any other."""
    got = np.asarray(got)
    assert got.dtype == want.dtype
    assert got.shape == want.shape
    if want.dtype.kind == "f":
        nan = np.isnan(want)
        np.testing.assert_array_equal(np.isnan(got), nan)
        got, want = got[~nan], want[~nan]
    assert got.tobytes() == want.tobytes(), f"got {got}, expected {want}"


def assert_same_bits(got: object, want: np.ndarray) -> None:
    """As `assert_same`, to the last bit of a NaN: for elements that are only moved."""
    got = np.asarray(got)
    assert got.dtype == want.dtype
    assert got.shape == want.shape
    assert got.tobytes() == want.tobytes(), f"got {got}, expected {want}"


def program(cm: sv.Simulated, n: int = 100) -> np.ndarray:
    """A sort and a look-up twice, each a phase, and copies: every primitive runs."""
    v = cm.vector(np.random.default_rng(3).integers(0, 50, n))
    for _ in range(2):
        with cm.phase("sort"):
            order = sv.rank(v)
        with cm.phase("look up"):
            v = sv.get(v, order)
    copies, _ = sv.distribute(v, v % 3)
    return copies.to_numpy()


def square_and_sum(cm: sv.Simulated) -> None:
    """The sum of squares: v * v, then a reduction."""
    v = cm.vector(np.arange(8.0))
    sv.reduce(v * v, sv.ADD)


def count_letters(cm: sv.Simulated) -> None:
    """How often each of 4 letters occurs: a concurrent write; and everyone reads its own letter's count."""
    letters = cm.vector(np.array([0, 1, 0, 0, 2, 0, 3, 0]))
    counts = sv.send(cm.full(8, 1, np.int32), letters, sv.ADD, into=cm.full(4, 0, np.int32))
    sv.get(counts, letters)


def unit_steps(program, model: sv.Model) -> float:
    """The predicted time in steps of an abstract machine, for the tests of models."""
    cm = sv.Simulated(4, model=model)
    program(cm)
    return round(cm.ledger.seconds / model.values["step"], 6)

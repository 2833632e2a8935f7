"""SplitMix64 against its definition in integers of any size."""

import numpy as np

from dt3d.ordering.hashing import GOLDEN, finalised, mixed


def splitmix64(state):
    z = state
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
    z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
    return z ^ z >> 31


def test_it_is_what_its_authors_say():
    # the first numbers of java.util.SplittableRandom(0), which is SplitMix64
    for k, want in enumerate([0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F], 1):
        state = k * int(GOLDEN) % 2**64
        assert splitmix64(state) == want
        assert finalised.py_func(np.uint64(0)) == 0
    for i, seed in ((0, 0), (1, 0), (12345, 7), (2**31, 2**31 - 1)):
        assert int(mixed(i, seed)) == splitmix64((i + seed * int(GOLDEN) + 0x632BE59BD9B4E019) % 2**64)

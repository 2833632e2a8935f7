"""Columns have one meaning each, and the names of edges and children can be read back."""

import numpy as np

from dt3d.threaded2d import columns as c


def test_an_edge_s_name_has_its_triangle_and_its_side():
    names = {
        (c.triangle(c.edge(t, k)), c.side(c.edge(t, k))) for t in (0, 1, 77, 2**29 - 1) for k in range(3)
    }
    assert names == {(t, k) for t in (0, 1, 77, 2**29 - 1) for k in range(3)}
    assert c.edges_of(np.array([0, 2**29 - 1])).tolist() == [
        c.edge(t, k) for t in (0, 2**29 - 1) for k in range(3)
    ]


def test_a_word_of_children_names_the_first_and_says_how_it_came():
    for first in (4, 1000, 2**30 - 1):
        assert (c.first_child(2 * first), c.is_subdivided(2 * first)) == (first, False)
        assert (c.first_child(2 * first + 1), c.is_subdivided(2 * first + 1)) == (first, True)


def test_no_two_columns_of_a_thread_s_row_are_one():
    source = {name: value for name, value in vars(c).items() if name.isupper() and isinstance(value, int)}
    layout = {"INFINITE", "NEIGHBOR", "CHILD", "LOCK", "NODE_WORDS", "SHARED_ROWS", "STATE_COLUMNS"}
    phases = {"BEGIN", "HEAD_START", "LOCK_CAVITY", "SUBDIVIDE", "LEGALISE", "CHANGE"}
    shared = {
        "USED",
        "STOP",
        "SOFT_LIMIT",
        "CRITICAL",
        "HEAD",
        "TAIL",
        "YIELD_EVERY",
        "SWAPS_LEFT",
        "MOST_LOOKS",
    }
    state = source.keys() - layout - phases - shared
    for names, most in ((state, c.STATE_COLUMNS), (shared, c.SHARED_ROWS), (phases, len(phases))):
        values = sorted(source[name] for name in names)
        assert values == list(range(len(values)))
        assert len(values) <= most
    assert [c.NEIGHBOR, c.CHILD, c.LOCK, c.NODE_WORDS] == [3, 6, 7, 8]

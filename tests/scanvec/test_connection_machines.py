"""Seconds of the Connection Machines, by hand: 8 elements on 4 processors."""

import numpy as np
import pytest

import scanvec as sv

from .cases import count_letters, square_and_sum


def test_seconds_of_a_cm5():
    cm = sv.Simulated(4, model=sv.CM5)
    count_letters(cm)
    c = sv.CM5.values
    # two steps of two elements a node; 4 messages of four bytes, and 5: a packet each
    expected = 2 * (c["issue"] + 2 * c["route"]) + (4 + 5) * c["packet"]
    assert cm.ledger.seconds == pytest.approx(expected)


def test_a_long_message_is_several_packets_on_a_cm5():
    cm = sv.Simulated(4, model=sv.CM5)
    v = cm.vector(np.arange(8.0))
    sv.permute((v, v, v), cm.vector(np.arange(8)[::-1]))
    c = sv.CM5.values
    # two messages of 24 bytes
    assert cm.ledger.seconds == pytest.approx(c["issue"] + 2 * c["route"] + 2 * 2 * c["packet"])


def test_seconds_of_a_cm2():
    cm = sv.Simulated(4, model=sv.CM2)
    square_and_sum(cm)
    c = sv.CM2.values
    # 8-byte sums are two words
    expected = 2 * c["element"] + 2 * c["element"] + 2 * 2 * c["scan"] / c["clock"]
    assert cm.ledger.seconds == pytest.approx(expected)

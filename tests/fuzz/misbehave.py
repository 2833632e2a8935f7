"""A job that goes wrong in the way that is asked for; in a file of its own, so that processes start fast."""

from __future__ import annotations

import os
import time


def misbehave(what: str) -> str:
    """Hang, die or raise, as the word says; any other word comes back."""
    if what == "hang":
        time.sleep(3600)
    if what == "die":
        os._exit(7)
    if what == "raise":
        msg = "it is wrong"
        raise ValueError(msg)
    return what

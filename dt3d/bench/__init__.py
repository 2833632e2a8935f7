"""dt3d against other libraries, on one machine, in one run. The command line runs it; nothing else does."""

from .peers import PEERS
from .report import publish, written
from .rounds import Limits, Measured, compare
from .sets import DISTRIBUTIONS, Sites, from_file, generated

__all__ = [
    "DISTRIBUTIONS",
    "PEERS",
    "Limits",
    "Measured",
    "Sites",
    "compare",
    "from_file",
    "generated",
    "publish",
    "written",
]

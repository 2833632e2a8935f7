"""Beyond the paper: an execution of the exact mode in whole steps, each compiled as one, for a device.

The program is that of the package above, and so are the bounds on which exactness rests. What differs is how
it is laid out for XLA: arrays of capacities that grow instead of vectors of any length, lists of sites that
stand ready (`windows.py`) instead of a request for each cell, and only some of the open faces at a time.
"""

from .loop import extrapolate
from .tables import serves

__all__ = ["extrapolate", "serves"]

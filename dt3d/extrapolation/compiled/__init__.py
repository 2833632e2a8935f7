"""Extrapolation in whole steps, each compiled as one, for a device and exact decisions.

The algorithm is that of the package above, and so are the bounds on which exactness rests. What differs is
how it is laid out for XLA: arrays of capacities that grow instead of vectors of any length, lists of sites
that stand ready (`windows`) instead of requests and warrants, and only some of the open faces at a time.
"""

from .loop import serves, triangulate

__all__ = ["serves", "triangulate"]

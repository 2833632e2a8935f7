"""Beyond the paper: the extrapolation of sites as they are, every decision exact.

Signed distances are known between bounds; what the bounds leave open, integers decide.
"""

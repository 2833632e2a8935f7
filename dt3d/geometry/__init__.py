"""Sizes, circumcenters and barycentric weights of simplices, accurate for slivers, by threads.

Determinants are computed with pairs of doubles, which hold some 106 bits, of exact differences scaled by a
power of two. The few that even these leave open are computed with fractions.
"""

"""The numbers that Kohout, Kolingerova and Zara report (2004)."""

from __future__ import annotations

# Table 1, Dell P 410, two processors: points, searching threads to one specialised, best length of the queue
QUEUE = {
    1000: (2, 64), 5000: (3, 256), 10_000: (2, 512), 50_000: (3, 512),
    100_000: (3, 1024), 500_000: (3, 1024), 1_000_000: (3, 1024),
}  # fmt: skip

# Table 2 and Table 3, two processing elements: Shalla, P 410, PE 6400
BATCH = {
    1000: (1.132, 1.072, 1.642), 5000: (1.698, 1.787, 2.218), 10_000: (1.606, 1.910, 2.391),
    50_000: (1.695, 2.039, 2.342), 100_000: (1.749, 2.025, 2.422), 500_000: (1.745, 2.079, 2.399),
}  # fmt: skip
CIRCUMCIRCLE = {
    1000: (1.297, 1.491, 1.857), 5000: (1.516, 1.800, 2.169), 10_000: (1.531, 1.891, 2.297),
    50_000: (1.637, 2.004, 2.333), 100_000: (1.610, 1.979, 2.399), 500_000: (1.717, 2.032, 2.463),
    1_000_000: (None, 2.030, 2.424),
}  # fmt: skip

# section 5, PE 6400 with four processors: least and greatest speed-up on uniform and on real data
ON_FOUR = {"batch": ((3.36, 3.84), (3.71, 4.40)), "circumcircle": ((3.21, 3.93), (3.34, 4.09))}
# the same, two processors
ON_TWO = {"batch": ((2.34, 2.42), (2.38, 2.65)), "circumcircle": ((2.34, 2.46), (2.27, 2.62))}

# Table 4, about 100,000 uniform points: 2 and 4 processing elements. Hardwick's algorithm ran on an SGI Power
# Challenge, and its speed-up is over Dwyer's sequential algorithm; it is not made here.
TABLE4 = {
    "Hardwick": (1.82, 3.33),
    "optimistic": (2.28, 3.98),
    "batch": (2.42, 3.81),
    "circumcircle": (2.39, 3.73),
}

# Figure 13, 100,001 points of Crater Lake: P 410 (2), PE 6400 (4)
CRATER = {"batch": (2.01, 4.40), "circumcircle": (2.00, 4.09)}

# sections 4.2 and 4.3: the largest differences between distributions, in percent, on two and four processors
BETWEEN_DISTRIBUTIONS = {"batch": (5.0, 13.0), "circumcircle": (3.5, 11.0)}

# section 3.4: wrong triangles, and of how many, where the correction is left out
WRONG = (5, 2_000_000)

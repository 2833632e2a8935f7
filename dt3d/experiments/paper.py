"""What Teng et al. 1993 report: the numbers that the experiments print beside their own.

Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo. A Data-parallel Algorithm for Three-dimensional Delaunay
Triangulation and its Implementation. Supercomputing '93, 112-121.
"""

from __future__ import annotations

from dataclasses import dataclass

PROCESSORS = 32  # nodes of the paper's CM-5


@dataclass(frozen=True)
class PaperRow:
    """One row of the paper's Table 1 (32-node CM-5, double precision)."""

    name: str
    sites: int
    tetrahedra: int
    depth: int
    seconds: float
    face_expansions: int
    searched: float

    @property
    def per_tetrahedron(self) -> float:
        """Face expansions per tetrahedron."""
        return self.face_expansions / self.tetrahedra


TABLE1 = (
    PaperRow("rand.125", 125, 676, 6, 2.42, 1095, 81.7),
    PaperRow("rand.250", 250, 1489, 6, 4.40, 2311, 69.2),
    PaperRow("rand.500", 500, 3037, 6, 7.14, 4693, 65.4),
    PaperRow("rand.1000", 1000, 6361, 7, 11.84, 9732, 73.5),
    PaperRow("rand.2000", 2000, 12947, 7, 26.10, 19717, 85.3),
    PaperRow("rand.4000", 4000, 26252, 8, 61.17, 39812, 80.1),
    PaperRow("rand.8000", 8000, 52895, 8, 125.31, 80120, 88.6),
    PaperRow("rand.16000", 16000, 106693, 9, 299.77, 161060, 88.6),
    PaperRow("dodecahedron", 20, 40, 5, 0.65, 104, 20.0),
    PaperRow("cube", 343, 1296, 5, 6.54, 2417, 133.7),
)

RANDOM = tuple(row for row in TABLE1 if row.name.startswith("rand."))

# Table 2: seconds of the random sets by number of nodes, on another CM-5 than Table 1's
TABLE2 = {
    "rand.4000": {32: 55.03, 128: 15.31, 256: 11.63},
    "rand.16000": {32: 266.9, 128: 77.83, 256: 43.89},
}

# Table 3: inconsistencies in single precision, of the sets that can be made again
TOO_MANY = "too many"
TABLE3: dict[str, int | str] = {"rand.4000": 2, "rand.16000": 5, "cube": TOO_MANY}

# Figure 2: sites from which on bucketing beats brute force, about
BREAK_EVEN = 500

# Figure 3: the iteration by which most tetrahedra are found
MOST_BY_ITERATION = 4

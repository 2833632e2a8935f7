"""What Teng et al. 1993 report: the numbers that the experiments print beside their own.

Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo. A Data-parallel Algorithm for Three-dimensional Delaunay
Triangulation and its Implementation. Supercomputing '93, 112-121.
"""

from __future__ import annotations

from dataclasses import dataclass

PROCESSORS = 32  # nodes of the paper's CM-5
CM2_PROCESSORS = 16384  # of its CM-2


@dataclass(frozen=True)
class PaperRow:
    """One row of the paper's Table 1 (32-node CM-5, double precision); ``seconds`` are of the main loop."""

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
    PaperRow("torus", 256, 1328, 6, 4.34, 2346, 140.7),
    PaperRow("m1", 318, 1967, 6, 7.91, 2974, 134.0),
    PaperRow("cube", 343, 1296, 5, 6.54, 2417, 133.7),
    PaperRow("tori", 800, 5889, 7, 17.87, 9150, 156.3),
    PaperRow("spiral", 1248, 8799, 7, 28.62, 13818, 182.0),
    PaperRow("m2", 1366, 8938, 7, 27.58, 13571, 121.7),
    PaperRow("bust", 2630, 17249, 6, 91.33, 26338, 324.3),
    PaperRow("fract2", 2704, 16909, 10, 182.56, 26323, 724.4),
    # the scan that was read is hardly legible in the last two numbers of this row
    PaperRow("liss-5-8", 4200, 27550, 6, 113.22, 43084, 246.0),
    PaperRow("teapot", 4668, 27081, 6, 246.37, 43778, 617.4),
    PaperRow("phone1", 6070, 39429, 8, 371.19, 59739, 645.7),
    PaperRow("polymer.278", 278, 1670, 6, 5.15, 2538, 97.0),
    PaperRow("polymer.500", 500, 2904, 7, 6.64, 4516, 61.1),
    PaperRow("polymer.932", 932, 5424, 6, 16.82, 8524, 141.9),
)

RANDOM = tuple(row for row in TABLE1 if row.name.startswith("rand."))

# Table 2: seconds of the random sets by number of nodes, on another CM-5 than Table 1's
TABLE2 = {
    "rand.4000": {32: 55.03, 128: 15.31, 256: 11.63},
    "rand.16000": {32: 266.9, 128: 77.83, 256: 43.89},
}

# Table 3: inconsistencies in single precision, and the tetrahedra of those sets that could be finished
TOO_MANY = "too many"
TABLE3: dict[str, int | str] = {
    "rand.4000": 2,
    "rand.16000": 5,
    "torus": 27,
    "cube": TOO_MANY,
    "spiral": 8,
    "bust": TOO_MANY,
    "fract2": TOO_MANY,
    "liss-5-8": 19,
    "teapot": TOO_MANY,
    "phone1": TOO_MANY,
    "polymer.932": 10,
}
TABLE3_TETRAHEDRA = {
    "rand.4000": 26239,
    "rand.16000": 106879,
    "torus": 1351,
    "spiral": 8795,
    "liss-5-8": 27545,
    "polymer.932": 5432,
}

# Figure 2: sites from which on bucketing beats brute force, about
BREAK_EVEN = 500

# Figure 3: the iteration by which most tetrahedra are found
MOST_BY_ITERATION = 4

"""The tables and figures of Kohout, Kolingerova, Zara 2004: ``dt3d experiment kohout-NAME``."""

from .arc import arc
from .by_size import batch, circumcircle, end_of_batch
from .costs import measure_costs
from .crater import crater
from .distributions import preset
from .helping import helping
from .interleaving import interleaving
from .phases import phases
from .queue_length import queue
from .subdivision import subdivision
from .table4 import table4
from .wrong_triangles import wrong_triangles

__all__ = [
    "arc", "batch", "circumcircle", "crater", "end_of_batch", "helping", "interleaving", "measure_costs",
    "phases", "preset", "queue", "subdivision", "table4", "wrong_triangles",
]  # fmt: skip

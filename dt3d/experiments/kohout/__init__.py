"""The tables and figures of Kohout, Kolingerova, Zara 2004: ``dt3d experiment kohout-NAME``."""

from .crater import crater
from .phases import phases
from .queue_length import queue
from .speedups import arc, batch, circumcircle, subdivision, table4

__all__ = ["arc", "batch", "circumcircle", "crater", "phases", "queue", "subdivision", "table4"]

"""Exact insertion in 3D on a CPU."""

from .loop import Outcome, triangulate

__all__ = ["Outcome", "triangulate"]

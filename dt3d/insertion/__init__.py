"""Exact insertion in 3D on a CPU."""

from .driver import Outcome, triangulate

__all__ = ["Outcome", "triangulate"]

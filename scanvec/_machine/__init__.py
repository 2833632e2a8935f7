"""Machines: what each supplies, and how vectors lie on it."""

"""Cost models: the time of a step from its counts."""

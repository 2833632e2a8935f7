"""What is where in a workspace, and the digits of its integers.

Nothing here needs the compiler.
"""

from __future__ import annotations

SLACK_INDEX = 0
# addresses, 0 where a function was not needed yet: of the stages behind the filters (`open_stages`); of what
# finds the address of another; and of what insertion in space seldom calls
ORIENT2D_OPEN, IN_CIRCLE_OPEN, ORIENT3D_OPEN, IN_SPHERE_OPEN = 1, 2, 3, 4
FINDER, CONFLICTS, LINK_WIDE = 5, 6, 7
INTEGERS_INDEX = 8  # from here on
WORKSPACE_SIZE = 2048  # an in-sphere determinant of 78 digits a coordinate takes 24 * 78 integers

# The slack is nothing beside a step of a lattice if it is less than this part of M^3 or M^5, with M the
# greatest difference of coordinates.
NEGLIGIBLE = 2.0**-110
DIGIT_BITS = 27  # of exact integers, here and in JAX
HALF_DIGIT = 1 << (DIGIT_BITS - 1)

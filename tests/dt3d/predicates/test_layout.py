"""The parts of a workspace do not overlap, and the integers fit."""

from dt3d.predicates import layout


def test_all_parts_have_room():
    places = [layout.SLACK_INDEX, layout.ORIENT2D_OPEN, layout.IN_CIRCLE_OPEN, layout.ORIENT3D_OPEN]
    places.append(layout.IN_SPHERE_OPEN)
    assert sorted(set(places)) == sorted(places)
    assert max(places) < layout.INTEGERS_INDEX
    # coordinates of bits 2^-1074 to 2^1023, and a difference of two: 78 digits
    digits = (1023 + 1074 + 1) // layout.DIGIT_BITS + 1
    assert layout.INTEGERS_INDEX + 24 * digits <= layout.WORKSPACE_SIZE

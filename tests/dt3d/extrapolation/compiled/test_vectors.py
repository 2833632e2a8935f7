"""What the vectors do for the compiled steps."""

from dt3d.extrapolation.compiled import stages

from .steps import assert_equal_to_insertion, compiled, random_set


def test_faces_that_no_other_stage_settles_go_to_the_vectors(monkeypatch):
    monkeypatch.setitem(stages.WIDER_STAGE, stages.Stage.WINDOW, stages.Stage.VECTORS)
    points = random_set(2000)
    found, _ = compiled(points)
    assert_equal_to_insertion(points, found)
    assert found.counts.exact_decisions > 0

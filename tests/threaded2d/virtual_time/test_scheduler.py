"""Virtual time: repeatable, sound, and near the paper's speed-ups on four processors."""

from dataclasses import replace

import numpy as np
import pytest

from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.virtual_time.costs import Costs
from dt3d.threaded2d.virtual_time.scheduler import simulate

from ..families import EVERY_SET, uniform

# of the proportions that were measured, so that the tests do not depend on the machine's load
COSTS = Costs(visit=60e-9, node=40e-9, test=15e-9)
PAPER_AT_4 = {"batch": 3.81, "circumcircle": 3.73, "optimistic": 3.98}


def options(method, threads, **changes):
    return Options(method=method, threads=threads, order="random", queue_length=1024, **changes)


@pytest.mark.parametrize("method", ["batch", "circumcircle", "optimistic", "pessimistic"])
@pytest.mark.parametrize("elements", [1, 3, 64])
def test_runs_repeat_and_insert_all(method, elements):
    points = uniform(500)
    run = simulate(points, options(method, max(2, elements)), elements, COSTS)
    assert run == simulate(points, options(method, max(2, elements)), elements, COSTS)
    assert run.triangles == 2 * (len(points) - 1)  # with the ghosts, by Euler's relation
    assert 0 < run.busy <= 1 + 1e-9
    assert (run.tests > 0) == (method == "circumcircle" and elements > 1)


@pytest.mark.parametrize("name", EVERY_SET)
def test_every_set_ends(name):
    points = EVERY_SET[name](200)
    n = len(np.unique(points, axis=0))
    for method, threads, elements in (("batch", 5, 2), ("circumcircle", 6, 3), ("optimistic", 4, 4)):
        run = simulate(points, options(method, threads, helping=True), elements, COSTS)
        assert run.triangles == 2 * (n - 1)


def test_one_element_takes_as_long_as_the_sequential_method():
    points = uniform(2000)
    alone = simulate(points, options("sequential", 1), 1, COSTS)
    assert alone.seconds > COSTS.visit * sum(alone.visited) > 0
    critical = simulate(points, options("pessimistic", 1), 1, COSTS)
    assert critical.seconds == pytest.approx(alone.seconds)
    for method in ("circumcircle", "optimistic"):
        one = simulate(points, options(method, 1), 1, COSTS)
        assert 0.999 * alone.seconds < one.seconds < 1.2 * alone.seconds


def test_four_elements_come_within_a_fifth_of_the_paper():
    points = uniform(100_000)
    alone = simulate(points, options("sequential", 1), 1, COSTS).seconds
    for method, paper in PAPER_AT_4.items():
        speed_up = alone / simulate(points, options(method, 4), 4, COSTS).seconds
        assert abs(speed_up / paper - 1) < 0.2, (method, speed_up)


def test_what_is_left_open_is_corrected_on_request():
    points = uniform(5000)
    chosen = options("circumcircle", 16, head_start=False, interleave=1)
    run = simulate(points, chosen, 16, COSTS, count_corrected=True)
    assert run.given_up > 0  # with so many threads some deadlocks come about
    assert run.corrected > 0
    assert run.triangles == 2 * (len(points) - 1)
    assert run == replace(simulate(points, chosen, 16, COSTS), corrected=run.corrected)
    assert sum(run.inserted) == len(points) - 3


def test_a_helper_pays_for_the_element_that_it_takes():
    points = uniform(3000)
    chosen = Options(method="batch", threads=4, order="random", queue_length=16, interleave=1)
    plain = simulate(points, chosen, 4, COSTS)
    assert simulate(points, chosen, 4, COSTS._replace(get=1e-6)).seconds > plain.seconds
    helping = replace(chosen, helping=True)
    cheap, dear = (simulate(points, helping, 4, COSTS._replace(get=s)) for s in (0.0, 1e-6))
    assert cheap.seconds < dear.seconds
    # the specialised thread, which is the last, has less of the location left to do
    assert cheap.visited[-1] < plain.visited[-1]


def test_errors():
    with pytest.raises(ValueError, match="elements must be 1 to 64, got 65"):
        simulate(uniform(10), options("optimistic", 2), 65, COSTS)
    walking = Options(method="batch", threads=2, location="walk")
    with pytest.raises(ValueError, match="location='dag' only"):
        simulate(uniform(10), walking, 2, COSTS)

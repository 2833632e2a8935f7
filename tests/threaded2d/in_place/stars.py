"""Structures without a history, for tests of what changes them in place."""

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.in_place import star
from dt3d.threaded2d.mesh import ROOTS
from dt3d.threaded2d.virtual_time.costs import prepared


def begun(points, threads=1):
    """The store of a run of which no step is done, and its tools."""
    options = Options(method="optimistic", threads=threads, order="random", location="walk")
    store, schedule = prepared(points, options)
    store.shared[c.USED, 0] = ROOTS + 2 * len(schedule.order)  # nodes have numbers by the order
    return store, star.tools(store, schedule, options)


def half_inserted(points):
    """A store with half of the sites, its tools, and the sites left."""
    store, tools = begun(points)
    half = len(tools.schedule.order) // 2
    tools.schedule.parts[0, 1] = half
    assert star.METHOD.run(store.mesh(), 0, tools) == 0
    return store, tools, tools.schedule.order[half:]

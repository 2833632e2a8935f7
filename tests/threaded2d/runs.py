"""Structures for tests: with all sites of a set inserted, or with half of them."""

import numpy as np

from dt3d.threaded2d import sequential
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.mesh import Store
from dt3d.threaded2d.steps import DONE
from dt3d.threaded2d.virtual_time.costs import prepared
from dt3d.threaded2d.work_sharing import share

SEQUENTIAL = Options(method="sequential", order="random")


def inserted(points: np.ndarray, count: int | None = None) -> tuple[Store, np.ndarray]:
    """A store with so many sites, or all, beside those of the first triangle; and the sites left."""
    store, schedule = prepared(points, SEQUENTIAL)
    order = schedule.order
    count = len(order) if count is None else count
    tools = sequential.tools(store, share(order[:count], np.array([0, count])), SEQUENTIAL)
    assert sequential.METHOD.run(store.mesh(), 0, tools) == DONE
    return store, order[count:]


def half_inserted(points: np.ndarray) -> tuple[Store, np.ndarray]:
    """A store with half of its sites, and the other sites."""
    return inserted(points, (len(np.unique(points, axis=0)) - 3) // 2)

"""`verify` says of right and of changed meshes what the definition says, found by brute force."""

import numpy as np
import pytest

from dt3d.threaded2d import verify as verify2d
from dt3d.verification import verify

from .brute import delaunay
from .meshes import facets_of

RUNS = {2: 80, 3: 40}


def drop(rng, points, rows):
    if len(rows) == 1:
        return points, rows
    return points, np.delete(rows, rng.integers(len(rows)), axis=0)


def double(rng, points, rows):
    return points, np.concatenate([rows, rows[[rng.integers(len(rows))]]])


def add_any(rng, points, rows):
    return points, np.concatenate([rows, [rng.permutation(len(points))[: rows.shape[1]]]])


def rename_one(rng, points, rows):
    rows = rows.copy()
    rows[rng.integers(len(rows)), rng.integers(rows.shape[1])] = rng.integers(len(points))
    return points, rows


def exchange_two(rng, points, rows):
    a, b = rng.integers(len(points), size=2)
    return points, np.where(rows == a, b, np.where(rows == b, a, rows))


def move_one(rng, points, rows):
    points = points.copy()
    points[rng.integers(len(points))] = points[rng.integers(len(points), size=2)].mean(axis=0)
    return points, rows


def flip(rng, points, rows):
    """Two simplices about a facet become those about the edge of their far vertices."""
    inner = sorted(sorted(f) for f, sides in facets_of(rows).items() if len(sides) == 2)
    facet = inner[rng.integers(len(inner))] if inner else []
    sides = facets_of(rows).get(frozenset(facet), [])
    far = [v for t in sides for v in rows[t].tolist() if v not in facet]
    if len(far) + len(facet) != rows.shape[1] + 1:
        return points, rows
    new = [[*far, *facet[:k], *facet[k + 1 :]] for k in range(len(facet))]
    return points, np.concatenate([np.delete(rows, sides, axis=0), new])


def glue_a_sheet(rng, points, rows):
    other = np.where(np.isin(rows, rng.permutation(len(points))[:2]), rows, rows + len(points))
    return np.concatenate([points, points]), np.concatenate([rows, other])


def turn_and_shuffle(rng, points, rows):
    return points, rng.permutation(rng.permuted(rows, axis=1))


HARMS = [drop, double, add_any, rename_one, exchange_two, move_one, flip, glue_a_sheet, turn_and_shuffle]


def is_delaunay(points, rows):
    """By the definition: each simplex is there, once, and nothing else; of equal sites any one."""
    first = {p: i for i, p in reversed(list(enumerate(map(tuple, points.tolist()))))}
    named = [frozenset(first[tuple(points[v].tolist())] for v in row) for row in rows]
    used: dict = {}
    for v in np.unique(rows):
        used.setdefault(tuple(points[v].tolist()), []).append(v)
    return (
        len(set(named)) == len(named)
        and set(named) == delaunay(points)
        and all(len(equal) == 1 for equal in used.values())
    )


@pytest.mark.parametrize("harms", [1, 2])
@pytest.mark.parametrize("kind", ["random", "lattice"])
@pytest.mark.parametrize("d", [2, 3])
def test_changed_meshes(d, kind, harms):
    prove, rng = (verify2d, verify)[d - 2], np.random.default_rng([d, harms])
    seen = {True: 0, False: 0}
    while sum(seen.values()) < RUNS[d]:
        n = int(rng.integers(d + 1, 9))
        points = rng.random((n, d)) if kind == "random" else rng.integers(0, 3, (n, d)).astype(float)
        points = np.unique(points, axis=0)
        rows = np.array([sorted(s) for s in delaunay(points)])
        if not len(rows):
            continue
        assert prove(points, rows, perturbed=True)
        assert prove(points, rows)
        for harm in rng.choice(HARMS, harms):
            points, rows = harm(rng, points, rows)
        right = is_delaunay(points, rows)
        assert bool(prove(points, rows, perturbed=True)) == right
        if kind == "random":  # no ties
            assert bool(prove(points, rows)) == right
        seen[right] += 1
    assert min(seen.values()) > 1  # both answers are tried

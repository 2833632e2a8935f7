"""The main loop on a device: waves of open faces, each expanded and attached by compiled steps."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

import scanvec as sv
from scanvec._running import computing

from ..._errors import InternalError
from ...predicates.traced.digits import limbs_of
from ..outcome import Outcome
from ..points import Point
from ..warrants import NO_SITE
from .expand import AHEAD, FOUND, HULL, TIE, WIDER, Expansion, expand
from .general import GeneralCode
from .mesh import (
    TETRAHEDRA_PER_SITE,
    Batch,
    Queue,
    attach,
    check_places,
    defer,
    empty_queue,
    grown,
    grown_queue,
    planted,
    pop,
)
from .seeds import MOST_SEEDS, SITES_PER_SEED, apart, windows_about, wrapped
from .ties import expand_ties
from .wide import Rows, expand_widely
from .windows import SITES_PER_CELL, cells_of, even, grid_of, windows_of

FEWEST_SITES = 2000  # for fewer, compiling these steps takes longer than all else
SMALLEST = 8192  # sites that arrays are made for, at least


class Layout(NamedTuple):
    """How many faces are together in a step, and in the loops inside it."""

    wave: int
    chunk: int
    wide: int


# On a CPU the data of a chunk fit into a core's cache.
LAYOUTS = {"cpu": Layout(2**13, 2048, 1024)}
OTHERWISE = Layout(2**17, 2**17, 2**15)

# The stages of a face: its window, a wide search, ties in a window, and the general code.
WINDOW, WIDE, TIES, GENERAL = range(4)
NEXT = {WINDOW: WIDE, WIDE: GENERAL, TIES: GENERAL, GENERAL: GENERAL}


def serves(sites: np.ndarray) -> bool:
    """Whether distinct sites (n, 3) are many, and fill space evenly."""
    return len(sites) >= FEWEST_SITES and even(sites)


class Triangulation:
    """The state of a run and its steps."""

    def __init__(
        self, machine: sv.Machine, sites: np.ndarray, tetrahedra_per_site: int = TETRAHEDRA_PER_SITE
    ) -> None:
        self.tetrahedra_per_site = tetrahedra_per_site
        self.seconds: dict[str, float] = {}
        self.face_expansions = self.exact_decisions = self.sites_searched = 0
        # of each stage beyond the first: faces, how many have come, and how many of those wait
        self.queues: dict[int, Queue] = {}
        self.tails: dict[int, int] = {}
        self.waiting: dict[int, int] = {}
        begin = time.perf_counter()
        n = len(sites)
        capacity = max(SMALLEST, 1 << (n - 1).bit_length())
        finest = grid_of(sites, SITES_PER_CELL)
        cell = cells_of(sites, finest)
        self.order = np.argsort(cell, kind="stable")
        self.sites = sites[self.order]
        self.general = GeneralCode(machine, sites, self.order)
        self.windows = windows_of(self.sites, finest, capacity)
        cells = int(finest.nx) * int(finest.ny) * int(finest.nz)
        starts = np.full(max(2 * capacity, cells) + 1, n, np.int32)
        starts[: cells + 1] = np.searchsorted(cell[self.order], np.arange(cells + 1))
        padded = np.zeros((3, capacity))
        padded[:, :n] = self.sites.T
        self.points = Point(*(jnp.asarray(x) for x in padded))
        self.host_windows = self.windows
        self.windows = jax.tree.map(jnp.asarray, self.windows)
        self.rows = jax.tree.map(jnp.asarray, Rows(finest, starts))
        self.ahead = AHEAD * float(finest.side)
        layout = LAYOUTS.get(jax.default_backend(), OTHERWISE)
        self.layout = Layout(*(min(x, capacity) for x in layout))
        self.width = self.layout.wave
        self.lattice = self.general.lattice
        self.capacity = capacity
        self._add("buckets", begin)

    def _add(self, phase: str, begin: float) -> None:
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - begin

    def plant(self) -> None:
        begin = time.perf_counter()
        n = len(self.sites)
        count = min(MOST_SEEDS, max(1, n // SITES_PER_SEED))
        chosen = np.random.default_rng(0).choice(n, count, replace=False)
        facets = wrapped(
            self.sites, self.host_windows, windows_about(self.sites[chosen], self.host_windows), chosen
        )
        rows = self._proved(facets)
        if not len(rows):
            rows = self.general.seeds(chosen)
        rows = apart(rows, n)
        self.mesh = planted(rows, self.tetrahedra_per_site * self.capacity, self.width)
        self.iteration = [len(rows)]
        self._add("first facets", begin)

    def _proved(self, facets: np.ndarray) -> np.ndarray:
        m = len(facets)
        faces = np.zeros((3, self.width), np.int32)
        faces[:, :m] = facets.T
        faces[:, m : 2 * m] = facets.T[[1, 0, 2]]
        expansion, searched = self._expand_in_windows(tuple(faces), np.int32(2 * m))
        self.face_expansions += 2 * m
        self.sites_searched += int(searched)
        site, status, low = (np.asarray(x) for x in expansion[:3])
        front, back = slice(0, m), slice(m, 2 * m)
        stands = (status[front] <= HULL) & (status[back] <= HULL) & (low[front] + low[back] > 0)
        right = [
            np.column_stack([facets, site[front]])[stands & (status[front] == FOUND)],
            np.column_stack([facets[:, [1, 0, 2]], site[back]])[stands & (status[back] == FOUND)],
        ]
        return np.concatenate(right)

    def step(self, stage: int) -> None:
        """Expand a wave of the faces that have come to a stage; those it cannot settle go on to the next."""
        begin = time.perf_counter()
        queue = self.mesh.fresh if stage == WINDOW else self.queues[stage]
        queue, batch = pop(queue, self.mesh.corners, self.mesh.neighbors, self.width)
        if stage == WINDOW:
            self.mesh = self.mesh._replace(fresh=queue)
        else:
            self.queues[stage] = queue
        expansion, searched = self._expand(stage, batch)
        self._add("face expansion", begin)
        begin = time.perf_counter()
        self.mesh, facts = attach(self.mesh, batch, expansion, self.layout.chunk)
        after, self.fresh, self.tail, contradictions, unplaced, *statuses = np.asarray(facts).tolist()
        if stage:
            self.waiting[stage] -= min(self.width, self.waiting[stage])
        for status, next_stage in ((WIDER, NEXT[stage]), (TIE, TIES)):
            if statuses[status]:
                self._defer(next_stage, batch, expansion, status, statuses[status])
        settled = statuses[FOUND] + statuses[HULL]
        self.face_expansions += settled
        self.exact_decisions += settled if stage in (TIES, GENERAL) else 0
        self.sites_searched += int(searched)
        self.iteration.append(after - sum(self.iteration))
        self._add("dead faces", begin)
        if contradictions:
            msg = f"{contradictions} tetrahedra contradict others, which exact decisions exclude"
            raise InternalError(msg)
        check_places(unplaced, len(self.mesh.table))
        # a face goes through at most four stages, so an endless run would have endless tetrahedra
        if 2 * after > len(self.sites) ** 2:
            msg = f"{after} tetrahedra of {len(self.sites)} sites were found, more than any triangulation has"
            raise InternalError(msg)

    def _defer(self, stage: int, batch: Batch, expansion: Expansion, status: int, count: int) -> None:
        if stage not in self.queues:
            self.queues[stage] = empty_queue(2 * self.capacity)
            self.tails[stage] = self.waiting[stage] = 0
        while self.tails[stage] + self.width > len(self.queues[stage].half):
            self.queues[stage] = grown_queue(self.queues[stage])
        self.queues[stage] = defer(self.queues[stage], batch, expansion, np.int32(status))
        self.tails[stage] += count
        self.waiting[stage] += count

    def _expand(self, stage: int, batch: Batch) -> tuple[Expansion, Any]:
        if stage == WINDOW:
            return self._expand_in_windows(batch.face, batch.count)
        if stage == WIDE:
            return expand_widely(
                self.points, batch.face, batch.bound, batch.count, self.lattice, self.rows, self.layout.wide
            )
        if stage == TIES:
            digits, rank = self.digits
            return expand_ties(
                self.points, digits, rank, batch.face, batch.bound, batch.count, self.lattice, self.windows,
                self.layout.chunk,
            )  # fmt: skip
        return self._decide(batch)

    def _expand_in_windows(self, face: Any, count: Any) -> tuple[Expansion, Any]:
        chunk = self.layout.chunk
        return expand(self.points, face, count, self.lattice, self.ahead, self.windows, chunk)

    @cached_property
    def digits(self) -> tuple[Any, Any]:
        """Coordinates as integers, and the sites' places in the lexicographic order."""
        limbs = limbs_of(self.sites)
        padded = np.zeros((3, len(limbs), self.capacity), np.int32)
        padded[:, :, : len(self.sites)] = limbs.transpose(2, 0, 1)
        rank = np.zeros(self.capacity, np.int32)
        rank[: len(self.sites)] = self.order
        return tuple(tuple(jnp.asarray(x) for x in axis) for axis in padded), jnp.asarray(rank)

    def _decide(self, batch: Batch) -> tuple[Expansion, int]:
        m = int(batch.count)
        site = np.full(self.width, NO_SITE, np.int32)
        if m:
            faces = np.stack([np.asarray(v)[:m] for v in batch.face], axis=1)
            site[:m], searched = self.general.expand(faces)
        status = np.where(site == NO_SITE, HULL, FOUND).astype(np.int32)
        nothing = np.zeros(self.width)
        return Expansion(site, status, nothing, nothing), searched if m else 0

    def run(self, report: Callable[[int, int, int], None] | None) -> None:
        self.plant()
        self.fresh = self.tail = 4 * self.iteration[0]
        self._report(report)
        while True:
            waiting = {WINDOW: self.fresh} | self.waiting
            full = [stage for stage, w in waiting.items() if w >= self.width]
            some = full or [stage for stage, w in waiting.items() if w]
            if not some:
                return
            while self._is_full():
                self.mesh = grown(self.mesh, self.width)
            self.step(min(some))
            self._report(report)

    def _report(self, report: Callable[[int, int, int], None] | None) -> None:
        if report is not None:
            report(len(self.iteration), self.fresh + sum(self.waiting.values()), sum(self.iteration))

    def _is_full(self) -> bool:
        size = len(self.mesh.corners)
        return 4 * (sum(self.iteration) + self.width) > size or self.tail + 3 * self.width > size

    def result(self) -> Outcome:
        begin = time.perf_counter()
        m = sum(self.iteration)
        corners = np.asarray(self.mesh.corners)[: 4 * m].reshape(-1, 4)
        neighbors = np.asarray(self.mesh.neighbors)[: 4 * m].reshape(-1, 4) >> 2
        iteration = np.repeat(np.arange(1, len(self.iteration) + 1, dtype=np.int32), self.iteration)
        self._add("neighbors", begin)
        return Outcome(
            self.order.astype(np.int32)[corners],
            neighbors,
            iteration,
            per_iteration=self.iteration,
            face_expansions=self.face_expansions,
            sites_searched=self.sites_searched,
            exact_decisions=self.exact_decisions,
            seconds=self.seconds,
        )


def triangulate(
    machine: sv.Machine, sites: np.ndarray, report: Callable[[int, int, int], None] | None = None
) -> Outcome:
    """Triangulate distinct sites (n, 3) in lexicographic order, exactly."""
    with computing():
        run = Triangulation(machine, sites)
        run.run(report)
        return run.result()

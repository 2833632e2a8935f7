"""The main loop on a device: waves of open faces, each expanded and attached by compiled steps.

It is Algorithm Parallel Extrapolation (Teng et al. 1993, section 3) with only some of the open faces at a
time, the exact mode's begin and its expansions. An exact answer does not depend on when it is asked for.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np

import scanvec as sv
from scanvec._running import computing

from ..._errors import InternalError
from ..clock import Clock
from ..consistency import check_progress
from ..faces import Face
from ..outcome import Counts, Outcome, Report
from ..warrants import NO_SITE
from . import stages
from .cap_search import expand_in_caps
from .exact_ties import expand_ties
from .first_tetrahedra import chosen_sites, without_common_vertices, wrapped_facets
from .mesh import (
    TETRAHEDRA_PER_SITE,
    Facts,
    Mesh,
    Queue,
    attach,
    begun_with,
    check_places,
    defer,
    empty_queue,
    facts_of,
    grown,
    grown_queue,
    pop,
)
from .stages import FOUND, HULL, TIE, WIDER, Batch, Expansion, Stage
from .tables import CellSites, in_cells
from .vectors import VectorProgram
from .window_search import expand_in_windows


class Expander:
    """Expands batches of faces, stage by stage."""

    def __init__(self, machine: sv.Machine, given: np.ndarray, cells: CellSites) -> None:
        self.cells = cells
        self.vectors = VectorProgram(machine, given, cells.order)

    def expand(self, stage: Stage, batch: Batch) -> tuple[Expansion, int]:
        """The outcome for each face, and how many sites were examined."""
        tables, layout = self.cells.tables, self.cells.layout
        if stage == Stage.VECTORS:
            return self._by_vectors(batch)
        if stage == Stage.WINDOW:
            expansion, searched = expand_in_windows(tables, batch, layout.chunk)
        elif stage == Stage.CAP:
            expansion, searched = expand_in_caps(tables, batch, layout.cap_chunk)
        else:
            expansion, searched = expand_ties(tables, self.cells.digits, batch, layout.chunk)
        return expansion, searched

    def _by_vectors(self, batch: Batch) -> tuple[Expansion, int]:
        m, wave, searched = int(batch.filled), self.cells.layout.wave, 0
        site = np.full(wave, NO_SITE, np.int32)
        if m:
            faces = np.stack([np.asarray(v)[:m] for v in batch.face], axis=1)
            site[:m], searched = self.vectors.expand(faces)
        status = np.where(site == NO_SITE, HULL, FOUND).astype(np.int32)
        unknown = np.zeros(wave)
        return Expansion(*map(jnp.asarray, (site, status, unknown, unknown))), searched

    def first_tetrahedra(self, out: Outcome) -> np.ndarray:
        """Tetrahedra (m, 4) at some first facets, no two of which share a vertex."""
        sites = self.cells.sites
        chosen = chosen_sites(len(sites))
        rows = self._checked(wrapped_facets(sites, self.cells.windows, chosen), out)
        if not len(rows):
            rows = self.vectors.first_tetrahedra(chosen)
        return without_common_vertices(rows, len(sites))

    def _checked(self, facets: np.ndarray, out: Outcome) -> np.ndarray:
        """The tetrahedra on both sides of those facets (m, 3) that their expansions prove to be Delaunay."""
        m, wave = len(facets), self.cells.layout.wave
        faces = np.zeros((3, wave), np.int32)
        faces[:, :m] = facets.T
        faces[:, m : 2 * m] = facets.T[[1, 0, 2]]
        face = Face(*map(jnp.asarray, faces))
        batch = Batch(face.a, face, jnp.full(wave, jnp.inf, jnp.float64), jnp.int32(2 * m))
        expansion, searched = self.expand(Stage.WINDOW, batch)
        out.add(Counts(2 * m, int(searched), 0))
        site, status, low = (np.asarray(x) for x in expansion[:3])
        front, back = slice(0, m), slice(m, 2 * m)
        proved = (status[front] <= HULL) & (status[back] <= HULL) & (low[front] + low[back] > 0)
        right = [
            np.column_stack([facets, site[front]])[proved & (status[front] == FOUND)],
            np.column_stack([facets[:, [1, 0, 2]], site[back]])[proved & (status[back] == FOUND)],
        ]
        return np.concatenate(right)


class Deferred:
    """The queue of a stage beyond the first."""

    def __init__(self, capacity: int) -> None:
        self.queue: Queue = empty_queue(capacity)
        self.tail = self.waiting = 0  # faces that have come, and how many of those wait

    def put(self, batch: Batch, expansion: Expansion, status: int, count: int) -> None:
        """Put in the ``count`` faces of a batch that have a status."""
        while self.tail + len(batch.half) > len(self.queue.half):
            self.queue = grown_queue(self.queue)
        self.queue = defer(self.queue, batch, expansion, np.int32(status))
        self.tail += count
        self.waiting += count


class Loop:
    """The state of a run: the mesh, the faces that wait, and what has been counted."""

    def __init__(
        self, machine: sv.Machine, sites: np.ndarray, tetrahedra_per_site: int = TETRAHEDRA_PER_SITE
    ) -> None:
        self.out, self.sites = Outcome(), sites
        self.clock = Clock(machine)
        with self.clock.phase("buckets"):
            self.cells = in_cells(sites)
            self.layout = self.cells.layout
            self.expander = Expander(machine, sites, self.cells)
        with self.clock.phase("first facets"):
            rows = self.expander.first_tetrahedra(self.out)
            capacity = tetrahedra_per_site * self.layout.capacity
            self.mesh: Mesh = begun_with(rows, capacity, self.layout.wave)
        self.out.waves.append(len(rows))
        # of the queue of fresh faces: those that wait, and its end
        self.fresh = self.tail = 4 * len(rows)
        self.deferred: dict[Stage, Deferred] = {}

    def run(self, report: Report | None) -> Outcome:
        """Expand waves until no face is open."""
        self._report(report)
        while True:
            waiting = {Stage.WINDOW: self.fresh} | {s: q.waiting for s, q in self.deferred.items()}
            full = [stage for stage, w in waiting.items() if w >= self.layout.wave]
            some = full or [stage for stage, w in waiting.items() if w]
            if not some:
                return self._result()
            while self._is_full():
                self.mesh = grown(self.mesh, self.layout.wave)
            self._step(min(some))
            self._report(report)

    def _step(self, stage: Stage) -> None:
        """Expand a wave of the faces that have come to a stage; those it cannot settle go on to the next."""
        with self.clock.phase("face expansion"):
            batch = self._take(stage)
            expansion, searched = self.expander.expand(stage, batch)
        with self.clock.phase("dead faces"):
            self.mesh, numbers = attach(self.mesh, batch, expansion, self.layout.chunk)
            facts = facts_of(numbers)
            self.fresh, self.tail = facts.fresh, facts.tail
            for status, to in ((WIDER, stages.WIDER_STAGE[stage]), (TIE, Stage.TIES)):
                if facts.statuses[status]:
                    if to not in self.deferred:
                        self.deferred[to] = Deferred(2 * self.layout.capacity)
                    self.deferred[to].put(batch, expansion, status, facts.statuses[status])
            settled = facts.statuses[FOUND] + facts.statuses[HULL]
            exact = settled if stage in (Stage.TIES, Stage.VECTORS) else 0
            self.out.add(Counts(settled, int(searched), exact))
            self.out.waves.append(facts.tetrahedra - self.out.tetrahedra)
        self._check(facts)

    def _take(self, stage: Stage) -> Batch:
        """The next wave of faces of a stage."""
        queue = self.mesh.fresh if stage == Stage.WINDOW else self.deferred[stage].queue
        batch: Batch
        queue, batch = pop(queue, self.mesh.corners, self.mesh.neighbors, self.layout.wave)
        if stage == Stage.WINDOW:
            self.mesh = self.mesh._replace(fresh=queue)
        else:
            waiting = self.deferred[stage]
            waiting.queue = queue
            waiting.waiting -= min(self.layout.wave, waiting.waiting)
        return batch

    def _check(self, facts: Facts) -> None:
        """Raise InternalError where tetrahedra contradict others, or the run cannot come to an end."""
        if facts.contradictions:
            msg = f"{facts.contradictions} tetrahedra contradict others, which exact decisions exclude"
            raise InternalError(msg)
        check_places(facts.unplaced, len(self.mesh.table))
        # a face goes through at most four stages, so an endless run would have endless tetrahedra
        check_progress(self.out, len(self.cells.sites), exact=True)

    def _report(self, report: Report | None) -> None:
        if report is not None:
            waiting = self.fresh + sum(q.waiting for q in self.deferred.values())
            report(len(self.out.waves), waiting, self.out.tetrahedra)

    def _is_full(self) -> bool:
        size, wave = len(self.mesh.corners), self.layout.wave
        return 4 * (self.out.tetrahedra + wave) > size or self.tail + 3 * wave > size

    def _result(self) -> Outcome:
        out = self.out
        with self.clock.phase("neighbors"):
            m = out.tetrahedra
            corners = np.asarray(self.mesh.corners)[: 4 * m].reshape(-1, 4)
            out.simplices = self.cells.order.astype(np.int32)[corners]
            out.neighbors = np.asarray(self.mesh.neighbors)[: 4 * m].reshape(-1, 4) >> 2
        from ..rounds import rounds_of  # loads numba, which takes a second, when it is needed

        with self.clock.phase("rounds"):
            out.iteration, out.per_iteration = rounds_of(self.sites, out.simplices, out.neighbors)
        out.seconds = self.clock.seconds
        return out


def extrapolate(machine: sv.Machine, sites: np.ndarray, report: Report | None = None) -> Outcome:
    """Triangulate distinct sites (n, 3) in lexicographic order, exactly."""
    with computing():
        return Loop(machine, sites).run(report)

"""What `dt3d triangulate` runs: in the plane or in space, and which options go with which."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from cyclopts import Parameter

from .._status import one_line

if TYPE_CHECKING:
    import numpy as np

    import scanvec as sv

SPACE_METHODS = ("insertion", "extrapolation")


@Parameter(name="*", group="What is run")
@dataclass(frozen=True)
class Choice:
    """The options of `dt3d triangulate` that say what is run.

    Attributes
    ----------
    method
        Insertion on this CPU, which is fast, or the paper's data-parallel extrapolation, which a machine or
        "perturb" asks for. Both find the same tetrahedra. In the plane: sequential, batch, circumcircle,
        pessimistic or optimistic, which find the same triangles.
    dimension
        2: in the plane, by x and y. 3: in space. If left out, as many coordinates as the points have.
    robustness
        Exact decisions, or the paper's perturbation and its count of inconsistencies.
    machine
        Where the vectors of an extrapolation live: on a device of JAX, or on simulated processors with a
        ledger of their steps.
    processors
        Number of simulated processors (32 if left out).
    threads
        At most so many threads insert; as many as there are cores if left out.
    dtype
        Precision of the perturbed search.
    seed
        Seed of the perturbation, and of the order of insertion in the plane.
    """

    method: Literal[
        "auto",
        "insertion",
        "extrapolation",
        "sequential",
        "batch",
        "circumcircle",
        "pessimistic",
        "optimistic",
    ] = "auto"
    dimension: Literal[2, 3] | None = None
    robustness: Literal["exact", "perturb"] = "exact"
    machine: Literal["device", "simulated"] | None = None
    processors: int | None = None
    threads: int | None = None
    dtype: Literal["float64", "float32"] | None = None
    seed: int = 0

    @property
    def only_in_space(self) -> list[str]:
        """The options, in words, that points in the plane do not have."""
        options = {
            "method": self.method if self.method in SPACE_METHODS else None,
            "robustness": None if self.robustness == "exact" else self.robustness,
            "machine": self.machine,
            "processors": self.processors,
            "dtype": self.dtype,
        }
        return [f"--{name} {value}" for name, value in options.items() if value is not None]

    @property
    def only_in_plane(self) -> bool:
        """Whether the method is one of those in the plane."""
        return self.method not in ("auto", *SPACE_METHODS)

    def check_output(self, output: Path) -> None:
        """A ValueError or OSError if the mesh cannot be written, as far as the options tell."""
        from .._mesh_plane import WRITERS, check_plane_path
        from ..files import check_mesh_path

        if self.dimension == 2 or self.only_in_plane:
            check_plane_path(output)
        elif self.dimension == 3 or self.only_in_space or output.suffix.lower() not in WRITERS:
            check_mesh_path(output)

    def check_points(self, points: np.ndarray, source: Path) -> None:
        """A ValueError if an option does not go with points of so many coordinates."""
        if points.shape[1] == 2 and self.only_in_space:
            what = (
                "--dimension 2 asks"
                if self.dimension == 2
                else f"{one_line(source)} has two coordinates per point, which asks"
            )
            msg = (
                f"{what} for a triangulation in the plane, and {self.only_in_space[0]} goes with points in "
                "space"
            )
            raise ValueError(msg)
        if points.shape[1] == 3 and self.only_in_plane:
            msg = (
                f"--method {self.method} goes with points in the plane, and {one_line(source)} has three "
                "coordinates per point; say --dimension 2 to triangulate by x and y"
            )
            raise ValueError(msg)

    def make_machine(self) -> sv.Machine | None:
        """The machine that is asked for; None if none is."""
        if self.processors is not None and self.machine != "simulated":
            msg = "--processors goes with --machine simulated"
            raise ValueError(msg)
        if self.machine == "simulated":
            from scanvec import Simulated

            return Simulated(processors=32 if self.processors is None else self.processors)
        if self.machine == "device":
            from scanvec import Device

            return Device()
        return None

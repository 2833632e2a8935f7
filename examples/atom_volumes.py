"""The volume of each atom of a crystal with a vacancy: Voronoi cells, clipped to the box.

Atoms of a face-centred cubic lattice tremble about their places, and one is missing. Its twelve neighbours
share its place, so their cells are larger. Look at the volumes printed, and at the red cells
in the middle of the picture, on a layer of the crystal.

    python examples/atom_volumes.py --cells 6 --write out/atom_volumes.png
"""

import argparse
from itertools import product
from pathlib import Path

import numpy as np
import pyvista as pv

import dt3d

FOUR = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]]) + 0.25  # of a cubic cell


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Measure the cells of atoms.")
    parser.add_argument("--cells", type=int, default=6, help="cubic cells along a side, of four atoms each")
    parser.add_argument("--write", type=Path, default=Path("out/atom_volumes.png"))
    options = parser.parse_args(argv)

    count = options.cells
    corners = np.array(list(product(range(count), repeat=3)), float)
    ideal = (corners[:, None] + FOUR).reshape(-1, 3)
    missing = np.argmin(np.linalg.norm(ideal - count / 2, axis=1))
    vacancy = ideal[missing]
    ideal = np.delete(ideal, missing, axis=0)
    atoms = ideal + np.random.default_rng(0).normal(0, 0.02, ideal.shape)

    clipped = dt3d.Voronoi(atoms).clipped([[0, 0, 0], [count] * 3])
    volumes = clipped.volumes
    print(f"{len(atoms)} atoms; volumes sum to the box within {abs(volumes.sum() - count**3):.1e}")
    distance = np.linalg.norm(ideal - vacancy, axis=1)
    nearest = np.isclose(distance, distance.min())
    inner = (np.abs(ideal - count / 2).max(axis=1) < count / 2 - 0.6) & ~nearest
    for name, which in (("beside the vacancy", nearest), ("elsewhere within", inner)):
        mean, spread = volumes[which].mean(), volumes[which].std()
        print(f"{np.count_nonzero(which):4} atoms {name}: volume {mean:.4f} +- {spread:.4f} (perfect 0.25)")

    normal = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)  # layers of atoms
    shown = np.flatnonzero((ideal - vacancy) @ normal < 0.1)
    vertices, faces, colors = [], [], []
    for atom in shown:
        cell = clipped.cell(atom)
        for face in cell.faces:
            faces += [len(face), *(v + len(vertices) for v in face)]
        vertices += cell.vertices.tolist()
        colors += [volumes[atom]] * len(cell.faces)
    cells = pv.PolyData(np.array(vertices), np.array(faces))
    plotter = pv.Plotter(off_screen=True, window_size=(1100, 900))
    plotter.set_background("white")
    bar = {"title": "volume", "color": "black", "position_x": 0.88, "vertical": True, "fmt": "%.2f"}
    plotter.add_mesh(
        cells,
        scalars=np.array(colors),
        show_edges=True,
        cmap="coolwarm",
        clim=(0.21, 0.29),
        scalar_bar_args=bar,
    )
    plotter.camera_position = [vacancy + 3 * count * normal, vacancy, (0, 0, 1)]
    plotter.camera.zoom(0.95)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

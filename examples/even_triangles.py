"""Gradients through a triangulation: sites move until all triangles have one area, in JAX.

The mean square of the areas is least where all are equal. Its gradient comes through `jax.grad`, with a new
triangulation in each step, in one compiled program. Where edges flip the energy jumps, so steps are small.
Look at the spread of the areas, and at the two meshes.

    python examples/even_triangles.py --sites 300 --steps 400 --write out/even_triangles.png
"""

import argparse
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pyvista as pv

import dt3d.jax as dj


def energy(inner: jax.Array, rim: jax.Array) -> jax.Array:
    """The mean square of the areas, over the square of their mean: 1 if all are equal."""
    points = jnp.concatenate([inner, rim])
    mesh = dj.delaunay(points)
    areas = dj.volumes(points, mesh)  # 0 in the padding
    return (areas**2).sum() * mesh.count / areas.sum() ** 2


def main(argv: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Even the triangles of a mesh out.")
    parser.add_argument("--sites", type=int, default=300)
    parser.add_argument("--steps", type=int, default=400)
    parser.add_argument("--write", type=Path, default=Path("out/even_triangles.png"))
    options = parser.parse_args(argv)

    rng = np.random.default_rng(0)
    side = max(2, round(np.sqrt(options.sites)))
    t = np.arange(side) / side
    rim = np.concatenate(
        [np.column_stack(p) for p in ((t, 0 * t), (1 + 0 * t, t), (1 - t, 1 + 0 * t), (0 * t, 1 - t))]
    )
    rim = jnp.asarray(rim, jnp.float32)
    first = jnp.asarray(0.05 + 0.9 * rng.random((options.sites, 2)), jnp.float32)

    @jax.jit
    def run(inner: jax.Array) -> tuple[jax.Array, jax.Array]:
        def step(inner: jax.Array, k: jax.Array) -> tuple[jax.Array, jax.Array]:
            value, slope = jax.value_and_grad(energy)(inner, rim)
            length = jnp.linalg.norm(slope, axis=1, keepdims=True)
            pace = 0.1 / jnp.sqrt(options.sites) * (1 - k / options.steps)  # a tenth of the spacing, at first
            moved = inner - pace * slope / jnp.maximum(length, length.mean())
            return jnp.clip(moved, 0.01, 0.99), value

        return jax.lax.scan(step, inner, jnp.arange(options.steps))

    last, values = run(first)
    for k in np.unique(np.linspace(0, options.steps - 1, 5).astype(int)):
        spread = 100 * np.sqrt(max(values[k] - 1, 0))
        print(f"step {k:4}: the standard deviation of the areas is {spread:.0f} % of their mean")

    plotter = pv.Plotter(shape=(1, 2), off_screen=True, border=False, window_size=(1600, 800))
    plotter.set_background("white")
    for panel, inner in enumerate((first, last)):
        points = jnp.concatenate([inner, rim])
        mesh = dj.delaunay(points)
        triangles = np.asarray(mesh.simplices)[: int(mesh.count)]
        flat = np.column_stack([points, np.zeros(len(points))])
        surface = pv.PolyData.from_regular_faces(flat, triangles)
        areas = np.asarray(dj.volumes(points, mesh))[: len(triangles)]
        plotter.subplot(0, panel)
        title = f"{'after' if panel else 'before'}: areas, by their mean"
        plotter.add_text(title, color="black", font_size=14)
        bar = {
            "title": "",
            "color": "black",
            "width": 0.5,
            "position_x": 0.25,
            "fmt": "%.1f",
        }
        look = {"clim": (0, 2), "cmap": "coolwarm", "show_edges": True, "lighting": False}
        plotter.add_mesh(surface, scalars=areas / areas.mean(), scalar_bar_args=bar, **look)
        plotter.view_xy()
        plotter.camera.focal_point = (0.5, 0.46, 0)
        plotter.camera.position = (0.5, 0.46, 2.3)
    options.write.parent.mkdir(parents=True, exist_ok=True)
    plotter.screenshot(options.write)
    plotter.close()
    print(f"wrote {options.write}")


if __name__ == "__main__":
    main()

"""A window on a triangulation: the cut faces the eye, sliders say what is shown, keys what colours mean.

VTK's own loop of events runs in compiled code, where Python cannot answer Ctrl-C. So the events are processed
in a loop of Python's, and what goes wrong in a callback, which VTK would print and forget, ends the loop.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ._display import check_screen
from ._optional import optional
from ._scene import Choice, Scene, explained, title_of
from ._space_picture import INK, add_bar, coloured, lay, look_at, surface, whiten
from ._space_plot import quiet

if TYPE_CHECKING:
    import pyvista

PAUSE = 0.01  # seconds between looks for events
SIZE = (1200, 900)
KEYS = 9  # digits that colour
SLIDER = {"style": "modern", "color": INK, "interaction_event": "always", "title_height": 0.018}
HEAD, FOOT = 0.13, 0.13  # shares of the height for the lines above, and the sliders below
FIRST, EACH, LONG, HIGH = 0.14, 0.25, 0.2, 0.06  # where sliders begin, side by side, and how long they are


class Window:
    """A window that is not open yet; `run` opens it.

    Parameters
    ----------
    scene : Scene
        What is shown.
    choice : Choice
        What of it at first, as `Scene.chosen` returns it.
    title : str
        Of the window.
    off_screen : bool
        Whether to do without a screen, for tests.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """

    def __init__(
        self, scene: Scene, choice: Choice, title: str = "dt3d", *, off_screen: bool = False
    ) -> None:
        pv = optional("pyvista", "a window")
        self.scene, self.choice = scene, choice
        self.error: BaseException | None = None
        self.open = True
        self.edges = True
        self.sliders: dict[str, Any] = {}  # VTK's, by their titles
        self.names = scene.names
        with quiet(pv):
            self.plotter: pyvista.Plotter = pv.Plotter(title=title, window_size=SIZE, off_screen=off_screen)
        whiten(self.plotter)
        self.mesh = surface(scene, choice)
        self._colour()
        self._add_sliders()
        look_at(self.plotter, self.mesh, choice, HEAD, FOOT)
        self.plotter.add_axes(color=INK, viewport=(0.0, 0.0, 0.12, 0.14))

    def run(self) -> None:
        """Open the window; returns when it is closed.

        Raises
        ------
        KeyboardInterrupt
            For Ctrl-C; the window is closed then.
        """
        plotter = self.plotter
        try:
            plotter.show(interactive_update=True, auto_close=False)
            self._listen()
            while self.open:
                cast(Any, plotter.iren).process_events()
                if self.error is not None:
                    raise self.error
                time.sleep(PAUSE)
        finally:
            plotter.close()

    def show(self, **changes: float | int | str | None) -> None:
        """Change what is shown: keywords of `Choice`. Where nothing would be left all stays as it was."""
        choice = replace(self.choice, **changes)  # type: ignore[arg-type]  # the names are the callers'
        if not self.scene.shown(choice).any():
            return
        recoloured = choice.scalars != self.choice.scalars
        self.choice = choice
        self.mesh.copy_from(surface(self.scene, choice))
        if recoloured:
            self._colour()
        self._describe()
        self.plotter.render()

    def press(self, key: str) -> None:
        """Do what a key stands for: a number colours, c turns the cut, e hides edges, r goes back, q ends."""
        if key.lower() in ("q", "escape"):
            self.open = False
        elif key == "c":
            away = np.subtract(self.plotter.camera.position, self.plotter.camera.focal_point)
            away /= np.linalg.norm(away)
            azimuth, elevation = np.degrees([np.arctan2(away[1], away[0]), np.arcsin(away[2])])
            self.show(azimuth=float(azimuth), elevation=float(elevation))
        elif key == "e":
            self.edges = not self.edges
            self._colour()
            self.plotter.render()
        elif key == "r":
            look_at(self.plotter, self.mesh, self.choice, HEAD, FOOT)
            self.plotter.render()
        elif key.isdigit() and 0 < int(key) <= len(self.names):
            self.show(scalars=self.names[int(key) - 1])

    def _colour(self) -> None:
        name = cast(str, self.choice.scalars)
        look = coloured(name, self.scene.values(name), of_points=name in self.scene.point_data)
        for title in list(self.plotter.scalar_bars.keys()):
            self.plotter.remove_scalar_bar(title, render=False)
        lay(self.plotter, self.mesh, look, edges=self.edges)
        if "scalars" in look:
            add_bar(self.plotter, name, look, 24)
        self._describe()

    def _describe(self) -> None:
        """The lines of text: what is shown, and what to do."""
        kind = "triangles" if self.scene.plane else "tetrahedra"
        shown = int(self.scene.shown(self.choice).sum())
        count = f"{shown:,} of {len(self.scene.simplices):,} {kind}; {explained(str(self.choice.scalars))}"
        keys = ", ".join(f"{k} {title_of(name)}" for k, name in enumerate(self.names[:KEYS], 1))
        how = "drag the mesh to turn it, the sliders to cut and peel it; wheel: zoom; shift and drag: move\n"
        how += f"keys: {keys}, c cut towards the eye, e edges, r back, q end"
        for name, text, height, size in (("count", count, 0.945, 12), ("how", how, 0.885, 9)):
            cast(Any, self.plotter).add_text(
                text,
                position=(0.02, height),
                name=name,
                viewport=True,
                font_size=size,
                color=INK,
                render=False,
            )

    def _add_sliders(self) -> None:
        edges = self.scene.data["longest_edge"]
        low, high = np.log10(np.quantile(edges[edges > 0], 0.02)), np.log10(edges.max())
        longest = min(self.choice.longest or np.inf, edges.max())
        rows: list[tuple[str, Callable[[float], None], tuple[float, float], float]] = []
        if not self.scene.plane:
            rows.append(("cut", lambda x: self.show(cut=x), (0.0, 1.0), self.choice.cut or 0.0))
        if high > low:
            start = float(np.clip(np.log10(longest), low, high))
            rows.append(("longest edge", self._peel, (float(low), float(high)), start))
        if self.scene.last > 1:
            last = self.scene.last
            upto = float(self.choice.upto or last)
            rows.append(("up to iteration", lambda x: self.show(upto=round(x)), (1.0, float(last)), upto))
        for column, (title, act, bounds, start) in enumerate(rows):
            left = FIRST + EACH * column
            slider = cast(Any, self.plotter).add_slider_widget(
                self._guarded(act),
                list(bounds),
                value=start,
                title=title,
                pointa=(left, HIGH),
                pointb=(left + LONG, HIGH),
                fmt="%.0f" if title == "up to iteration" else "%.2f",
                **SLIDER,
            )
            self.sliders[title] = slider
            shape = slider.GetRepresentation()
            shape.SetSliderWidth(0.02)
            shape.SetSliderLength(0.012)
            shape.SetTubeWidth(0.006)
            shape.SetLabelHeight(0.018)
            if title == "longest edge":
                shape.SetLabelFormat(f"{longest:.3g}")

    def _peel(self, logarithm: float) -> None:
        """The slider is of the logarithm, and its label of the length."""
        longest = 10.0**logarithm
        edges = self.scene.data["longest_edge"]
        if longest >= edges.max() * (1 - 1e-9):
            longest = np.inf
        if "longest edge" in self.sliders:
            self.sliders["longest edge"].GetRepresentation().SetLabelFormat(
                f"{min(longest, edges.max()):.3g}"
            )
        self.show(longest=longest)

    def _listen(self) -> None:
        """Take over the keys, of which VTK and PyVista have others, and the end."""
        interactor = cast(Any, self.plotter.iren).interactor
        pressed = self._guarded(lambda: self.press(interactor.GetKeySym() or ""))
        interactor.AddObserver("KeyPressEvent", lambda *_: pressed())
        interactor.AddObserver("ExitEvent", lambda *_: setattr(self, "open", False))
        interactor.GetInteractorStyle().AddObserver("CharEvent", lambda *_: None)

    def _guarded(self, act: Callable[..., None]) -> Callable[..., None]:
        def guarded(*values: Any) -> None:  # VTK's
            try:
                act(*values)
            except BaseException as error:
                self.error = error

        return guarded


def show(scene: Scene, choice: Choice, title: str = "dt3d") -> None:
    """Open a window and return when it is closed.

    Raises
    ------
    ValueError
        If there is no screen, as `check_screen` says.
    ImportError
        If PyVista is not installed.
    KeyboardInterrupt
        For Ctrl-C.
    """
    optional("pyvista", "a window")
    check_screen()
    Window(scene, choice, title).run()

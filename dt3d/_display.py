"""Whether anything can be drawn here: by OpenGL without a window, and on a screen.

Both are asked in a process of their own. Where VTK finds no OpenGL library it may end the process, and X's
library waits for a screen on another host for as long as the network lets it.
"""

from __future__ import annotations

import functools
import os
import subprocess
import sys

PATIENCE = 60  # seconds; a first start of VTK from a slow disk takes ten

# a triangle has to come out: a window that opens and stays black is none
RENDER = """
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkFiltersSources import vtkRegularPolygonSource
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2
vtkObject.GlobalWarningDisplayOff()
source, mapper, actor = vtkRegularPolygonSource(), vtkPolyDataMapper(), vtkActor()
mapper.SetInputConnection(source.GetOutputPort())
actor.SetMapper(mapper)
renderer, window, image = vtkRenderer(), vtkRenderWindow(), vtkWindowToImageFilter()
renderer.AddActor(actor)
window.SetOffScreenRendering(1)
window.SetSize(32, 32)
window.AddRenderer(renderer)
window.Render()
image.SetInput(window)
image.Update()
raise SystemExit(0 if vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).max() > 100 else 3)
"""

# 4: there is no libX11, without which VTK opens no window either
CONNECT = """
import ctypes
try:
    x11 = ctypes.CDLL("libX11.so.6")
except OSError:
    raise SystemExit(4)
x11.XOpenDisplay.restype = ctypes.c_void_p
raise SystemExit(0 if x11.XOpenDisplay(None) else 3)
"""


@functools.cache
def renders() -> bool:
    """Whether VTK can render without a window here; asked once, which takes some half a second."""
    return _succeeds(RENDER)


def check_screen() -> None:
    """A ValueError that says the way out, unless a window can be opened.

    Raises
    ------
    ValueError
        If there is no screen, or the one that DISPLAY names does not answer.
    """
    if sys.platform != "linux":
        return
    way_out = "use --screenshot FILE.png, or --html FILE.html for a browser"
    name = os.environ.get("DISPLAY")
    if not name:  # VTK's windows are X's, on Wayland, too
        msg = f"there is no screen to open a window on (DISPLAY is not set); {way_out}"
        raise ValueError(msg)
    if not _succeeds(CONNECT):
        msg = f"the screen DISPLAY={name} does not answer; {way_out}"
        raise ValueError(msg)


def _succeeds(program: str) -> bool:
    try:
        # as the user would run it, but for the folder he is in, which may have a file vtkmodules.py
        done = subprocess.run(
            [sys.executable, "-P", "-c", program],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=PATIENCE,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0

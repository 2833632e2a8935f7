"""A screen without a monitor, and a browser without a window, for tests; skipped where they are not."""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1000,800",
    "--virtual-time-budget=20000",
)


class Screen:
    """An X server that draws into memory."""

    def __init__(self, name: str, folder: Path) -> None:
        self.name, self.folder = name, folder

    def picture(self) -> np.ndarray:
        """What is on the screen, uint8 (height, width, 3), from a file of xwd with big-endian words."""
        raw = (self.folder / "Xvfb_screen0").read_bytes()
        head = np.frombuffer(raw, ">u4", 25)
        start, height, line, colors = int(head[0]), int(head[5]), int(head[12]), int(head[19])
        pixels = np.frombuffer(raw, np.uint8, height * line, start + 12 * colors).reshape(height, -1, 4)
        return pixels[:, : int(head[4]), :3]


@contextlib.contextmanager
def screen(folder: Path):
    """A screen on a server of its own."""
    server = shutil.which("Xvfb")
    if server is None:
        pytest.skip("there is no Xvfb for a screen without a monitor")
    read, write = os.pipe()
    words = [server, "-displayfd", str(write), "-screen", "0", "1280x1024x24", "-fbdir", str(folder)]
    with open(os.devnull, "w") as nowhere:
        process = subprocess.Popen(words, pass_fds=[write], stdout=nowhere, stderr=nowhere)
    os.close(write)
    try:
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()  # comes when the server is ready, or the end when it is not
        if not number:
            pytest.skip("Xvfb does not start here")
        yield Screen(f":{number}", folder)
    finally:
        process.terminate()
        process.wait()


@functools.cache
def browser() -> str | None:
    """A browser that runs here; a wrapper may be in the path without the browser itself."""
    for name in BROWSERS:
        path = shutil.which(name)
        if path and subprocess.run([path, "--version"], capture_output=True, check=False).returncode == 0:
            return path
    return None


def browse(page: Path, profile: Path, *words: str, hash: str = "") -> str:
    """Open a page in a browser; returns what it prints."""
    program = browser()
    if program is None:
        pytest.skip(f"there is no browser: none of {', '.join(BROWSERS)} runs here")
    url = f"{page.resolve().as_uri()}{hash}"
    words = (*FLAGS, f"--user-data-dir={profile}", *words, url)
    done = subprocess.run([program, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout

"""``dt3d completion``: the words of dt3d for a shell."""

from __future__ import annotations

from typing import Literal

from .._status import Printer


def completion(shell: Literal["bash", "zsh", "fish"]) -> None:
    """Print a script by which a shell completes the words of dt3d when the Tab key is pressed.

    Its place: for bash ~/.local/share/bash-completion/completions/dt3d, for zsh a file _dt3d in a folder of
    fpath, for fish ~/.config/fish/completions/dt3d.fish

    Parameters
    ----------
    shell
        The shell that reads it.
    """
    from . import app

    script = app.generate_completion(prog_name="dt3d", shell=shell)
    Printer(highlight=False).print(script, markup=False, soft_wrap=True)

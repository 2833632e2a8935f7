"""Memory of this process, in bytes; None where the system does not tell."""

from __future__ import annotations

from pathlib import Path

STATUS = Path("/proc/self/status")
FORGET = Path("/proc/self/clear_refs")


def forget_peak() -> bool:
    """Let the peak be what is in use now; whether the system can."""
    try:
        FORGET.write_text("5")
    except OSError:
        return False
    return True


def resident() -> int | None:
    """What is in use now."""
    return _line("VmRSS")


def peak() -> int | None:
    """The most that was in use."""
    return _line("VmHWM")


def _line(name: str) -> int | None:
    try:
        lines = STATUS.read_text().splitlines()
    except OSError:
        return None
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith(f"{name}:")), None)

"""Whether compiled code is kept on disk, and what a user can do where it is not."""

from __future__ import annotations

import logging

CURE = "set the environment variable NUMBA_CACHE_DIR to a folder that can be written"


class Kept:
    """Whether what is compiled now will be there for the next process."""

    anywhere = True
    said = False

    @classmethod
    def lost(cls, folder: str, error: OSError) -> None:
        """Say once that what was compiled could not be saved."""
        if cls.anywhere and not cls.said:
            cls.said = True
            logging.getLogger("dt3d").warning(
                "what was compiled could not be kept in %s (%s): other processes compile it again; %s",
                folder, error.strerror or error, CURE,
            )  # fmt: skip

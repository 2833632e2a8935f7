"""``python -m dt3d``: the same as ``dt3d``."""

import sys

from dt3d import _command

sys.exit(_command.main())

"""Points and meshes from files: a file for each format, which checks every promise that the format makes.

VTK and meshio write, but do not read: where a file is damaged they hand over memory that nobody has written,
end the process, or go on for ever.
"""

from .meshes import Mesh, read_mesh
from .points import read_points

__all__ = ["Mesh", "read_mesh", "read_points"]

"""Points and meshes from files: a file for each format, which checks every promise that the format makes.

VTK and meshio write, but do not read: where a file is damaged they hand over memory that nobody has written,
end the process, or go on for ever.
"""

from .meshes import Mesh, read_mesh
from .points import Cloud, read_cloud, read_points

__all__ = ["Cloud", "Mesh", "read_cloud", "read_mesh", "read_points"]

"""Points from files, and triangulations into and from files, by the file's extension."""

from ._mesh_writing import check_mesh_path, write_mesh
from .reading import Mesh, read_mesh, read_points

__all__ = ["Mesh", "check_mesh_path", "read_mesh", "read_points", "write_mesh"]

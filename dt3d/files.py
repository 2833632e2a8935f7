"""Points from files, and triangulations into and from files, by the file's extension."""

from ._mesh_writing import check_mesh_path, write_mesh
from .reading import Cloud, Mesh, read_cloud, read_mesh, read_points

__all__ = ["Cloud", "Mesh", "check_mesh_path", "read_cloud", "read_mesh", "read_points", "write_mesh"]

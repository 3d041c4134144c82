"""Quality triangle meshes of planar domains.

    import driftmesh

    bay = driftmesh.generate("bay", seed=7)
    mesh = driftmesh.mesh(bay, min_angle=25, max_area=5000)
    mesh.points, mesh.triangles          # numpy arrays, not copied
    mesh.write("bay.vtu")

Lengths and areas are in the units of the input, angles in degrees.
"""

import pathlib as _pathlib
import tempfile as _tempfile

from . import _conversions
from ._errors import Cancelled, Error, FileError, InputError, InputWarning, LimitError
from ._native import (CheckReport, Decomposition, DistributedPiece, GhostedPiece, Load, Mesh, Progress, Pslg,
                      SimulatedRun, SizeField, __version__, add_ghost_layer, check, cut_domain, generate, generator_names, mesh, mesh_distributed, option_table,
                      outline, plot, read_decomposition, read_input, read_mesh, read_poly, simulate, size_on_mesh, write_distributed)
from ._native import holds_input as _holds_input
from ._progress import ProgressLine

__all__ = ["Cancelled", "CheckReport", "Decomposition", "DistributedPiece", "Error", "FileError", "GhostedPiece", "InputError",
           "InputWarning", "LimitError", "Load", "Mesh", "Progress", "ProgressLine", "Pslg", "SimulatedRun",
           "SizeField", "__version__", "add_ghost_layer", "check", "convert", "cut_domain", "generate", "generator_names", "mesh",
           "mesh_distributed", "option_table", "outline", "plot", "read", "read_decomposition", "read_input", "read_mesh", "read_poly",
           "simulate", "size_on_mesh", "to_meshio", "write_distributed"]


def read(path):
    """Read a file: a Pslg from a .poly, or a .node without an .ele next to it, and a Mesh from all others."""
    return read_input(path) if _holds_input(path) else read_mesh(path)


def convert(source, target, *, allow_outside=False):
    """Write the mesh in the file `source` to the file `target`, in the format that its extension names."""
    read_mesh(source, allow_outside=allow_outside).write(target)


def _picture(what):
    """PNG, for notebooks."""
    with _tempfile.TemporaryDirectory() as folder:
        path = _pathlib.Path(folder) / "picture.png"
        plot(what, path, width=800)
        return path.read_bytes()


Mesh._repr_png_ = Pslg._repr_png_ = _picture
Mesh.__iter__ = _conversions.columns
Mesh.to_meshio = _conversions.to_meshio
Mesh.to_dolfinx = _conversions.to_dolfinx
Mesh.to_ugrid = _conversions.to_ugrid


def to_meshio(mesh):
    """The mesh as a meshio.Mesh, as mesh.to_meshio() is."""
    return mesh.to_meshio()

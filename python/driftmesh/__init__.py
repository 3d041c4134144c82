"""Quality triangle meshes of planar domains.

    import driftmesh

    bay = driftmesh.generate("bay", seed=7)
    mesh = driftmesh.mesh(bay, min_angle=25, max_area=5000)
    mesh.points, mesh.triangles          # numpy arrays, not copied
    mesh.write("bay.vtu")

Lengths and areas are in the units of the input, angles in degrees.
"""

import importlib as _importlib
import importlib.util as _importlib_util
import pathlib as _pathlib
import tempfile as _tempfile

from . import _conversions
from ._errors import Cancelled, Error, FileError, InputError, InputWarning, LimitError
from ._native import (AdaptedMesh, AdaptiveMesh, CheckReport, Decomposition, Load, Mesh, Progress, Pslg, SizeField, SizeRule, __version__,
                      adapt_outline, adapt_part, check, cut_domain, generate, generator_names, mesh, option_table, outline, plot, read_decomposition,
                      read_input, read_mesh, read_poly, size_on_mesh)
from ._native import holds_input as _holds_input
from ._polygons import from_polygons
from ._progress import ProgressLine

# What needs MPI is a module of its own, loaded when one of these is first asked for; a package that was built without MPI lacks it.
_OF_RANKS = ["DistributedAdaptiveMesh", "DistributedPiece", "GhostedPiece", "SimulatedRun", "add_ghost_layer", "mesh_distributed", "simulate", "write_distributed"]

__all__ = ["AdaptedMesh", "AdaptiveMesh", "Cancelled", "CheckReport", "Decomposition", "Error", "FileError", "InputError", "InputWarning",
           "LimitError", "Load", "Mesh", "Progress", "ProgressLine", "Pslg", "SizeField", "SizeRule", "__version__", "adapt_outline", "adapt_part",
           "check", "convert", "cut_domain", "from_polygons", "generate", "generator_names", "mesh", "option_table", "outline", "plot", "read",
           "read_decomposition", "read_input", "read_mesh", "read_poly", "size_on_mesh", "to_meshio"]
if _importlib_util.find_spec("._ranks", __name__):
    __all__ += _OF_RANKS


def __getattr__(name):
    if name == "sizes":    # it imports numpy
        return _importlib.import_module(".sizes", __name__)
    if name not in _OF_RANKS:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    try:
        from . import _ranks
    except ImportError as missing:
        why = f"which cannot be loaded ({missing})" if name in __all__ else "which this package was built without"
        raise ImportError(f"driftmesh.{name} needs MPI, {why}; build driftmesh from its source where MPI is (docs/install.md)") from missing
    globals().update({each: getattr(_ranks, each) for each in _OF_RANKS})
    return globals()[name]


def __dir__():
    return sorted({*globals(), *__all__})


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

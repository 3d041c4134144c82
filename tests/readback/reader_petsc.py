import pathlib
import sys
import types

from answer import answer, counts, import_or_say

petsc4py = import_or_say("petsc4py")
is_h5 = sys.argv[1].endswith(".h5")
petsc4py.init(["reader", "-dm_plex_create_from_hdf5_xdmf"] if is_h5 else ["reader"])
from petsc4py import PETSc

world = PETSc.COMM_WORLD.tompi4py()
plex = PETSc.DMPlex().createFromFile(sys.argv[1], comm=PETSc.COMM_WORLD)
first, end = plex.getHeightStratum(0)
# Points that ranks share are leaves on all but one of them.
leaves = set(plex.getPointSF().getGraph()[1]) if world.size > 1 else set()
low, high = plex.getDepthStratum(0)
own = high - low - sum(int(low <= leaf < high) for leaf in leaves)
area = sum(plex.computeCellGeometryFVM(cell)[0] for cell in range(first, end))
facts = {"points": world.allreduce(own), "triangles": world.allreduce(end - first), "area": world.allreduce(area)}
sizes = world.allgather(end - first)
assert max(sizes) - min(sizes) <= 1, f"cells of the ranks: {sizes}"  # the file is read in parallel
if is_h5:  # the package without its compiled part, which this does not need
    package = types.ModuleType("driftmesh")
    package.__path__ = [str(pathlib.Path(__file__).resolve().parents[2] / "python" / "driftmesh")]
    sys.modules["driftmesh"] = package
    from driftmesh.petsc import add_labels_of_h5
    add_labels_of_h5(plex, sys.argv[1])


def counts_of(label):
    """Of each value how many cells or edges, of all ranks, each once."""
    own = [int(v) for v in plex.getLabelIdIS(label).getIndices() for point in plex.getStratumIS(label, v).getIndices()
           if point not in leaves]
    return counts(v % 1000000 for values in world.allgather(own) for v in values)  # tag 1000000 is that of marker 0


facts["regions"], facts["markers"] = counts_of("Cell Sets"), counts_of("Face Sets")
if not is_h5:  # labels by numbers or by names
    PETSc.Options().setValue("dm_plex_gmsh_use_regions", True)
    plex = PETSc.DMPlex().createFromFile(sys.argv[1], comm=PETSc.COMM_WORLD)
labels = {plex.getLabelName(i) for i in range(plex.getNumLabels())}
ours = labels - {"celltype", "depth", "Cell Sets", "Face Sets", "Vertex Sets"}
facts["names"] = {name: int(value) for name in sorted(ours) if not name.startswith(("marker ", "region "))
                  for values in world.allgather(list(plex.getLabelIdIS(name).getIndices())) for value in values}
if world.rank == 0:
    answer(".".join(map(str, PETSc.Sys.getVersion())), **facts)

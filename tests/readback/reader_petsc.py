import sys

from answer import answer, import_or_say

petsc4py = import_or_say("petsc4py")
petsc4py.init(["reader", "-dm_plex_create_from_hdf5_xdmf"] if sys.argv[1].endswith(".h5") else ["reader"])
from petsc4py import PETSc

world = PETSc.COMM_WORLD.tompi4py()
plex = PETSc.DMPlex().createFromFile(sys.argv[1], comm=PETSc.COMM_WORLD)
first, end = plex.getHeightStratum(0)
# Points that ranks share are leaves on all but one of them.
leaves = plex.getPointSF().getGraph()[1] if world.size > 1 else []
low, high = plex.getDepthStratum(0)
own = high - low - sum(int(low <= leaf < high) for leaf in leaves)
area = sum(plex.computeCellGeometryFVM(cell)[0] for cell in range(first, end))
facts = {"points": world.allreduce(own), "triangles": world.allreduce(end - first), "area": world.allreduce(area)}
sizes = world.allgather(end - first)
assert max(sizes) - min(sizes) <= 1, f"cells of the ranks: {sizes}"  # the file is read in parallel
if sys.argv[1].endswith(".msh"):
    # Tag 1000000 is that of marker 0.
    for fact, label in (("regions", "Cell Sets"), ("markers", "Face Sets")):
        values = plex.getLabelIdIS(label).getIndices()
        facts[fact] = {str(v % 1000000): plex.getStratumSize(label, v) for v in sorted(values, key=lambda v: v % 1000000)}
if world.rank == 0:
    answer(".".join(map(str, PETSc.Sys.getVersion())), **facts)

import sys

from answer import answer, counts, import_or_say

dolfinx = import_or_say("dolfinx")
from dolfinx import io, mesh
from mpi4py import MPI
import numpy

world = MPI.COMM_WORLD
with io.XDMFFile(world, sys.argv[1], "r") as file:
    domain = file.read_mesh(name="mesh")
    domain.topology.create_connectivity(1, 2)
    cells, facets = file.read_meshtags(domain, "mesh"), file.read_meshtags(domain, "facets")


def own(tags, dimension):
    """The values of what this rank owns, of all ranks."""
    number = domain.topology.index_map(dimension).size_local
    return [value for values in world.allgather(tags.values[tags.indices < number]) for value in values]


number = domain.topology.index_map(2).size_local
corners = domain.geometry.x[domain.geometry.dofmap.array.reshape(-1, 3)[:number]]
sides = corners[:, 1:] - corners[:, :1]
area = float(abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 1, 0] * sides[:, 0, 1]).sum() / 2)
facts = {"points": domain.topology.index_map(0).size_global, "triangles": domain.topology.index_map(2).size_global,
         "area": world.allreduce(area), "regions": counts(own(cells, 2)), "markers": counts(own(facets, 1))}
if world.rank == 0:
    answer(dolfinx.__version__, **facts)

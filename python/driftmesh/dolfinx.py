"""Meshes as those of dolfinx (FEniCSx): `to_dolfinx`."""

import dolfinx.cpp
import numpy as np
import ufl
from dolfinx import mesh as dolfinx_mesh

from ._shared import region_tags, told_by_owners


def _consecutive_numbers(communicator, piece):
    """Numbers of the points: those of the points that a rank owns follow one another, as dolfinx wants its input."""
    owned = piece.owners == piece.rank
    own_number = communicator.scan(int(owned.sum())) - int(owned.sum()) + np.cumsum(owned) - 1
    return told_by_owners(communicator, piece, own_number), owned


def _stay(piece):
    """As a partitioner: each triangle stays on the rank that has it and goes as a ghost to those that share a point of it."""
    count = len(piece.mesh.triangles)
    pairs = [np.column_stack((np.arange(count), np.full(count, piece.rank)))]  # the first rank of each triangle is its owner
    for rank, shared in piece.neighbors.items():
        near = np.flatnonzero(np.isin(piece.mesh.triangles, shared).any(axis=1))
        pairs.append(np.column_stack((near, np.full_like(near, rank))))
    pairs = np.concatenate(pairs)
    pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
    offsets = np.searchsorted(pairs[:, 0], np.arange(count + 1))
    ranks = dolfinx.cpp.graph.AdjacencyList_int32(pairs[:, 1].astype(np.int32), offsets.astype(np.int32))
    return lambda *_: ranks


def _tags(domain, dimension, corners, values):
    """Tags of the entities with these corners. They may lie on any rank, or on several."""
    entities, found = dolfinx.cpp.io.distribute_entity_data(domain._mesh, dimension, corners, values.astype(np.int32))
    domain.topology.create_connectivity(dimension, 0)
    domain.topology.create_connectivity(dimension, 2)
    return dolfinx_mesh.meshtags_from_entities(domain, dimension, dolfinx.cpp.graph.AdjacencyList_int32(entities), found)


def to_dolfinx(communicator, piece):
    """The mesh of all ranks as a mesh of dolfinx, and the tags of its cells and of its facets. Collective.

    `communicator` is the one of mpi4py that `piece` was made on. Each triangle stays on the rank that has it, which owns it.
    Ranks also get the triangles around the points that they share with others, as ghosts: dolfinx 0.5 does not join ranks
    without them. Tags of cells are regions, which must be whole numbers, or None without regions; tags of facets are markers
    of edges.
    """
    regions = region_tags(communicator, piece)
    numbers, owned = _consecutive_numbers(communicator, piece)
    triangles = numbers[piece.mesh.triangles]
    element = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.triangle, 1))
    domain = dolfinx_mesh.create_mesh(communicator, dolfinx.cpp.graph.AdjacencyList_int64(triangles), piece.mesh.points[owned],
                                      element, dolfinx_mesh.GhostMode.shared_facet, _stay(piece))
    cells = _tags(domain, 2, triangles, regions) if piece.has_regions else None
    return domain, cells, _tags(domain, 1, numbers[piece.mesh.edges], piece.mesh.edge_markers)

"""Meshes as PETSc's DMPlex, by petsc4py: `to_dmplex`."""

import numpy as np
from petsc4py import PETSc

from ._shared import region_tags, told_by_owners


def _add_stars(plex, communicator, piece, first):
    """Points that another rank owns point to it, by its number for them."""
    here = first + np.arange(len(piece.owners), dtype=np.int32)
    there = told_by_owners(communicator, piece, here)
    foreign = piece.owners != piece.rank
    remote = np.column_stack((piece.owners[foreign], there[foreign])).astype(PETSc.IntType)
    stars = PETSc.SF().create(comm=communicator)
    stars.setGraph(first + len(here), here[foreign].astype(PETSc.IntType), remote.ravel())
    plex.setPointSF(stars)


def _topology(communicator, piece):
    """Triangles, then points; interpolation adds the edges behind them, and those that ranks share to the star forest."""
    triangles = piece.mesh.triangles
    first = len(triangles)
    plex = PETSc.DMPlex().create(comm=communicator)
    plex.setDimension(2)
    plex.setChart(0, first + len(piece.owners))
    for cell in range(first):
        plex.setConeSize(cell, 3)
    plex.setUp()
    for cell, corners in enumerate((triangles + first).astype(PETSc.IntType)):
        plex.setCone(cell, corners)
    plex.symmetrize()
    plex.stratify()
    _add_stars(plex, communicator, piece, first)
    plex.interpolate()
    return plex


def _add_coordinates(plex, points, first):
    plex.setCoordinateDim(2)
    section = plex.getCoordinateSection()
    section.setNumFields(1)
    section.setFieldComponents(0, 2)
    section.setChart(first, first + len(points))
    for point in range(first, first + len(points)):
        section.setDof(point, 2)
        section.setFieldDof(point, 0, 2)
    section.setUp()
    plex.setCoordinatesLocal(PETSc.Vec().createWithArray(points.ravel().copy(), bsize=2, comm=PETSc.COMM_SELF))


def _add_labels(plex, mesh, regions, first):
    for name in ("Cell Sets", "Face Sets", "Vertex Sets"):
        plex.createLabel(name)
    for cell, region in enumerate(regions):
        plex.setLabelValue("Cell Sets", cell, region)
    for ends, marker in zip((mesh.edges + first).astype(PETSc.IntType), mesh.edge_markers):
        plex.setLabelValue("Face Sets", plex.getJoin(ends)[0], marker)
    for point in np.flatnonzero(mesh.point_markers):
        plex.setLabelValue("Vertex Sets", first + point, mesh.point_markers[point])


def to_dmplex(communicator, piece):
    """The mesh of all ranks as a DMPlex, each rank with its piece. Collective; nothing is gathered or moved.

    `communicator` is the one of mpi4py that `piece` was made on. Cells are the triangles of `piece.mesh` in order, and
    behind them come its points in order, then edges. The star forest joins the points and edges that ranks share. Labels:
    "Cell Sets" are regions, which must be whole numbers, "Face Sets" markers of edges, "Vertex Sets" those of points but 0.
    """
    regions = region_tags(communicator, piece)
    first = len(piece.mesh.triangles)
    plex = _topology(communicator, piece)
    _add_coordinates(plex, piece.mesh.points, first)
    _add_labels(plex, piece.mesh, regions, first)
    return plex

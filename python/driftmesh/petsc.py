"""Meshes as PETSc's DMPlex, by petsc4py: `to_dmplex`; and the labels of one read from .h5: `add_labels_of_h5`."""

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


def _label_cells(plex, tags):
    """`tags` of cells in order."""
    plex.createLabel("Cell Sets")
    for cell, tag in enumerate(tags):
        plex.setLabelValue("Cell Sets", cell, int(tag))


def _label_edges(plex, ends, markers):
    """`ends` are points of the plex."""
    plex.createLabel("Face Sets")
    for pair, marker in zip(ends.astype(PETSc.IntType), markers):
        plex.setLabelValue("Face Sets", plex.getJoin(pair)[0], int(marker))


def _label_as_named(plex, name, entities, number):
    """A label that is called so, as PETSc makes them of groups in .msh. Its own stay as they are."""
    if not plex.hasLabel(name):
        plex.createLabel(name)
        for entity in entities:
            plex.setLabelValue(name, entity, int(number))


def _label_edges_by_names(plex, names):
    """`names` by markers of edges."""
    for marker, name in names.items():
        here = plex.getStratumSize("Face Sets", int(marker))
        _label_as_named(plex, name, plex.getStratumIS("Face Sets", int(marker)).getIndices() if here else (), marker)


def _add_labels(plex, mesh, regions, first):
    _label_cells(plex, regions)
    _label_edges(plex, mesh.edges + first, mesh.edge_markers)
    plex.createLabel("Vertex Sets")
    for point in np.flatnonzero(mesh.point_markers):
        plex.setLabelValue("Vertex Sets", first + point, mesh.point_markers[point])
    _label_edges_by_names(plex, mesh.marker_names)
    for region, name in mesh.region_names.items():
        _label_as_named(plex, name, np.flatnonzero(mesh.regions == region), region)


def to_dmplex(communicator, piece):
    """The mesh of all ranks as a DMPlex, each rank with its piece. Collective; nothing is gathered or moved.

    `communicator` is the one of mpi4py that `piece` was made on. Cells are the triangles of `piece.mesh` in order, and
    behind them come its points in order, then edges. The star forest joins the points and edges that ranks share. Labels:
    "Cell Sets" are regions, which must be whole numbers, "Face Sets" markers of edges, "Vertex Sets" those of points but 0. Names of markers and
    regions are labels, too, unless PETSc has one of that name.
    """
    regions = region_tags(communicator, piece)
    first = len(piece.mesh.triangles)
    plex = _topology(communicator, piece)
    _add_coordinates(plex, piece.mesh.points, first)
    _add_labels(plex, piece.mesh, regions, first)
    return plex


def _rows_of_vertices(plex, corners):
    """For each vertex of the plex the row of the file that it is from. `corners`: rows of the corners of its cells."""
    low, high = plex.getDepthStratum(0)
    rows = np.full(high - low, -1)
    for cell, of_cell in enumerate(corners):
        closure = plex.getTransitiveClosure(cell)[0]
        rows[closure[(low <= closure) & (closure < high)] - low] = of_cell
    return low, rows


def add_labels_of_h5(plex, path):
    """Adds labels to a DMPlex that PETSc has read from the .h5 file at `path`, on any number of ranks. Collective.

    PETSc 3.18 reads no labels there. The plex is as it was read, -dm_plex_create_from_hdf5_xdmf, with cells and edges, and not
    yet distributed anew. Labels are those of `to_dmplex`; "Cell Sets" are tags of regions. Each rank reads the rows of its cells
    and all subsegments. Needs h5py.
    """
    import h5py
    communicator = plex.comm.tompi4py()
    count = plex.getHeightStratum(0)[1] - plex.getHeightStratum(0)[0]
    first = communicator.scan(count) - count
    with h5py.File(path) as file:
        corners = file["viz/topology/cells"][first:first + count]
        regions, markers = file["tags/cells"], file["tags/facets"]
        low, rows = _rows_of_vertices(plex, corners)
        order = np.argsort(rows)
        ends, of_ends = file["viz/topology/facets"][:], markers[:]
        places = np.searchsorted(rows, ends, sorter=order).clip(max=max(len(rows) - 1, 0))
        here = (rows[order[places]] == ends).all(axis=1) if len(rows) else np.zeros(len(ends), bool)
        _label_cells(plex, regions[first:first + count])
        vertices = low + order[places[here]]
        joined = np.array([len(plex.getJoin(pair)) == 1 for pair in vertices.astype(PETSc.IntType)], bool)
        _label_edges(plex, vertices[joined], of_ends[here][joined])
        _label_edges_by_names(plex, {marker: name for name, marker in markers.attrs.items()})
        for name, region in regions.attrs.items() if "region" in file["VTKHDF/CellData"] else ():
            here = np.flatnonzero(file["VTKHDF/CellData/region"][first:first + count] == region)
            _label_as_named(plex, name, here, regions[first + here[0]] if len(here) else 0)

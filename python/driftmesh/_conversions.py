"""Meshes as those of other programs. Each is imported where it is asked for."""

def to_meshio(mesh):
    """A meshio.Mesh: triangles, then the constrained edges as lines.

    Cell data `marker` and `region` have 0 for the other kind of cell; point data are `marker` and the attributes.
    """
    import meshio
    import numpy as np
    lines, triangles = mesh.edges, mesh.triangles
    regions = mesh.regions if len(mesh.regions) else np.zeros(len(triangles))
    cells = [("triangle", np.array(triangles)), ("line", np.array(lines))]
    cell_data = {"region": [np.array(regions), np.zeros(len(lines))],
                 "marker": [np.zeros(len(triangles), np.int32), np.array(mesh.edge_markers)]}
    point_data = {"marker": np.array(mesh.point_markers)} if len(mesh.point_markers) else {}
    if mesh.attributes.size:
        point_data["attribute"] = np.array(mesh.attributes)
    return meshio.Mesh(np.array(mesh.points), cells, point_data=point_data, cell_data=cell_data)


def to_dolfinx(mesh, communicator=None):
    """A mesh of dolfinx on one process, with tags of cells (regions; None without) and of facets (markers)."""
    from types import SimpleNamespace

    import numpy as np

    from .dolfinx import to_dolfinx as from_piece
    if communicator is None:
        from mpi4py import MPI
        communicator = MPI.COMM_SELF
    piece = SimpleNamespace(rank=0, mesh=mesh, owners=np.zeros(len(mesh.points), np.int32), neighbors={},
                            has_regions=len(mesh.regions) > 0)
    return from_piece(communicator, piece)


def to_ugrid(mesh, path, *, geographic=False):
    """A netCDF file of the UGRID conventions 1.0, by netCDF4: nodes, faces with their neighbors and regions, boundary edges.

    geographic: points are longitudes and latitudes, in degrees.
    """
    import netCDF4
    import numpy as np
    units = [("longitude", "degrees_east"), ("latitude", "degrees_north")] if geographic else \
        [("projection_x_coordinate", "m"), ("projection_y_coordinate", "m")]
    with netCDF4.Dataset(path, "w") as file:
        file.Conventions = "CF-1.8 UGRID-1.0"
        for name, count in (("node", len(mesh.points)), ("face", len(mesh.triangles)), ("edge", len(mesh.edges)), ("two", 2),
                            ("three", 3)):
            file.createDimension(name, count)

        def variable(name, kind, dimensions, values, **attributes):
            made = file.createVariable(name, kind, dimensions)
            made.setncatts(attributes)
            made[:] = values

        topology = file.createVariable("mesh", "i4")
        topology.setncatts({"cf_role": "mesh_topology", "topology_dimension": np.int32(2),
                            "node_coordinates": "node_x node_y", "face_node_connectivity": "face_nodes",
                            "face_face_connectivity": "face_links", "edge_node_connectivity": "edge_nodes"})
        for axis, (standard, unit) in enumerate(units):
            variable(f"node_{'xy'[axis]}", "f8", ("node",), mesh.points[:, axis], standard_name=standard, units=unit,
                     mesh="mesh", location="node")
        variable("face_nodes", "i4", ("face", "three"), mesh.triangles, cf_role="face_node_connectivity",
                 start_index=np.int32(0))
        variable("face_links", "i4", ("face", "three"), mesh.neighbors[:, [2, 0, 1]], cf_role="face_face_connectivity",
                 start_index=np.int32(0), flag_values=np.int32(-1), flag_meanings="out_of_mesh")
        variable("edge_nodes", "i4", ("edge", "two"), mesh.edges, cf_role="edge_node_connectivity", start_index=np.int32(0))
        variable("edge_marker", "i4", ("edge",), mesh.edge_markers, mesh="mesh", location="edge")
        if len(mesh.regions):
            variable("face_region", "f8", ("face",), mesh.regions, mesh="mesh", location="face")


def columns(mesh):
    """x, y and triangles, as matplotlib's triplot(*mesh) and its like take them."""
    return iter((mesh.points[:, 0], mesh.points[:, 1], mesh.triangles))

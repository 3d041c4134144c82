"""Meshes in other orders, pickled, and as those of other programs, which are skipped where they are not installed."""

import importlib.util
import pathlib
import pickle
import tempfile
import unittest

import driftmesh
import numpy as np

DOMAIN = driftmesh.Pslg([(0, 0), (3, 0), (3, 2), (0, 2), (1.5, 0), (1.5, 2)],
                        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)], segment_markers=[1, 1, 2, 1, 1, 3, 7],
                        regions=[(0.5, 0.5, 10, 0), (2.5, 0.5, 20, 0)], marker_names={7: "weir"}, region_names={10: "basin"})
MESH = driftmesh.mesh(DOMAIN, max_area=0.01)


def needs(module):
    return unittest.skipUnless(importlib.util.find_spec(module), f"needs {module}")


def arrays(mesh):
    return [mesh.points, mesh.triangles, mesh.edges, mesh.edge_markers, mesh.point_markers, mesh.attributes, mesh.regions,
            mesh.numbers, mesh.subdomains, mesh.ranks]


class Pickle(unittest.TestCase):
    def test_a_mesh_comes_back(self):
        for mesh in (MESH, driftmesh.mesh(DOMAIN, max_area=0.1, subdomains={"count": 3})):
            copy = pickle.loads(pickle.dumps(mesh))
            for one, other in zip(arrays(mesh), arrays(copy)):
                self.assertTrue(np.array_equal(one, other) and one.dtype == other.dtype)
            self.assertEqual((copy.marker_names, copy.region_names), (mesh.marker_names, mesh.region_names))

    def test_another_version_is_refused(self):
        state = MESH.__getstate__()
        with self.assertRaisesRegex(ValueError, "pickled by driftmesh 0.0.1"):
            driftmesh.Mesh.__new__(driftmesh.Mesh).__setstate__(("0.0.1", state[1]))


class Orders(unittest.TestCase):
    def test_bandwidth(self):
        corners = MESH.triangles
        widest = max(abs(corners[:, i] - corners[:, (i + 1) % 3]).max() for i in range(3))
        self.assertEqual(MESH.bandwidth, widest)
        ordered = MESH.ordered("rcm")
        self.assertLess(5 * ordered.bandwidth, MESH.bandwidth)
        self.assertTrue(driftmesh.check(ordered, DOMAIN, max_area=0.01))
        self.assertTrue(np.array_equal(MESH.ordered("given").points, MESH.points))
        with self.assertRaisesRegex(driftmesh.InputError, "must be given, hilbert or rcm"):
            MESH.ordered("best")

    def test_neighbors(self):
        neighbors = MESH.neighbors
        sides = {}
        for t, corners in enumerate(MESH.triangles):
            for i in range(3):
                sides.setdefault(frozenset((corners[(i + 1) % 3], corners[(i + 2) % 3])), []).append((t, i))
        for found in sides.values():
            (t, i), (other, j) = found if len(found) == 2 else (*found, (-1, None))
            self.assertEqual(neighbors[t, i], other)
            if j is not None:
                self.assertEqual(neighbors[other, j], t)


class OtherPrograms(unittest.TestCase):
    def test_columns_as_matplotlib_wants_them(self):
        x, y, triangles = MESH
        self.assertTrue(np.array_equal(np.column_stack((x, y)), MESH.points) and triangles.shape == MESH.triangles.shape)

    @needs("matplotlib")
    def test_matplotlib_draws_it(self):
        from matplotlib.figure import Figure
        lines, _ = Figure().subplots().triplot(*MESH)
        edges = {frozenset((a, b)) for corners in MESH.triangles.tolist() for a, b in zip(corners, corners[1:] + corners[:1])}
        self.assertEqual(np.isnan(lines.get_xdata().astype(float)).sum(), len(edges))  # one after each

    @needs("geopandas")
    def test_geopandas(self):
        import geopandas
        from shapely.geometry import Point, box
        land = geopandas.GeoDataFrame(geometry=[box(0, 0, 40, 30).difference(box(10, 10, 20, 20)), Point(60, 10).buffer(5)], crs="EPSG:32632")
        mesh = driftmesh.mesh(driftmesh.from_polygons(land), max_area=5)
        x, y = mesh.points[mesh.triangles].transpose(2, 0, 1)
        covered = abs(np.cross(np.c_[x[:, 1] - x[:, 0], y[:, 1] - y[:, 0]], np.c_[x[:, 2] - x[:, 0], y[:, 2] - y[:, 0]])).sum() / 2
        self.assertAlmostEqual(covered, land.area.sum(), places=6)
        with self.assertRaisesRegex(ValueError, "in degrees; project them"):
            driftmesh.from_polygons(land.to_crs("EPSG:4326"))

    @needs("xarray")
    def test_xarray(self):
        import xarray
        x, y = np.linspace(0, 3, 31), np.linspace(2, 0, 21)
        depth = xarray.DataArray(0.05 + 0.1 * x + 0 * y[:, None], dims=("y", "x"), coords={"x": x, "y": y})
        mesh = driftmesh.mesh(DOMAIN, size=driftmesh.sizes.raster(depth))
        centers = mesh.points[mesh.triangles].mean(axis=1)[:, 0]
        self.assertGreater((centers < 1).sum(), 2 * (centers > 2).sum())

    @needs("meshio")
    def test_meshio(self):
        mesh = driftmesh.to_meshio(MESH)
        cells = mesh.cells_dict
        self.assertTrue(np.array_equal(cells["triangle"], MESH.triangles) and np.array_equal(cells["line"], MESH.edges))
        self.assertTrue(np.array_equal(mesh.cell_data["region"][0], MESH.regions))
        self.assertTrue(np.array_equal(mesh.cell_data["marker"][1], MESH.edge_markers))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mesh.vtu"
            mesh.write(path)
            self.assertTrue(np.array_equal(driftmesh.read(path).triangles, MESH.triangles))

    @needs("dolfinx")
    def test_dolfinx_on_one_process(self):
        domain, cells, facets = MESH.to_dolfinx()
        self.assertEqual(domain.topology.index_map(2).size_local, len(MESH.triangles))
        self.assertIsNotNone(facets)
        whole = driftmesh.Mesh(MESH.points, MESH.triangles, edges=MESH.edges, edge_markers=MESH.edge_markers)
        self.assertIsNone(whole.to_dolfinx()[1])

    @needs("netCDF4")
    def test_ugrid(self):
        import netCDF4
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mesh.nc"
            MESH.to_ugrid(path)
            with netCDF4.Dataset(path) as file:
                topology = file["mesh"]
                self.assertEqual(topology.cf_role, "mesh_topology")
                x, y = (np.array(file[name][:]) for name in topology.node_coordinates.split())
                self.assertTrue(np.array_equal(np.column_stack((x, y)), MESH.points))
                faces = np.array(file[topology.face_node_connectivity][:])
                self.assertTrue(np.array_equal(faces, MESH.triangles))
                # Link k of a face is across its edge k, from its corner k to the next one.
                links = np.array(np.ma.filled(file[topology.face_face_connectivity][:], -1))
                for face, other in zip(*np.nonzero(links >= 0)):
                    side = {faces[face, other], faces[face, (other + 1) % 3]}
                    self.assertLessEqual(side, set(faces[links[face, other]]))
                self.assertTrue(np.array_equal(file["face_region"][:], MESH.regions))


if __name__ == "__main__":
    unittest.main()

"""The arrays of domains and meshes: what they hold, that nothing is copied, and who keeps what alive."""

import gc
import unittest
import weakref

import driftmesh
import numpy as np

MESH_VIEWS = ("points", "triangles", "edges", "edge_markers", "point_markers", "attributes", "regions", "numbers",
              "subdomains", "ranks")
DOMAIN_VIEWS = ("points", "segments", "segment_markers", "holes", "regions", "point_markers", "attributes")


def domain():
    """A square with a point marker, two attributes for each point, and a region in each half."""
    return driftmesh.Pslg([(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)], [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
                          segment_markers=[1, 1, 2, 3, 3, 4, 9], regions=[(0.5, 0.5, 7, 0), (1.5, 0.5, 8, 0.01)],
                          point_markers=[1, 2, 3, 4, 5, 6], attributes=[(k, -k) for k in range(6)])


class Contents(unittest.TestCase):
    def test_domain(self):
        pslg = domain()
        np.testing.assert_array_equal(pslg.points[1], [2, 0])
        np.testing.assert_array_equal(pslg.segments[6], [4, 5])
        np.testing.assert_array_equal(pslg.segment_markers, [1, 1, 2, 3, 3, 4, 9])
        np.testing.assert_array_equal(pslg.regions, [(0.5, 0.5, 7, 0), (1.5, 0.5, 8, 0.01)])
        np.testing.assert_array_equal(pslg.point_markers, [1, 2, 3, 4, 5, 6])
        np.testing.assert_array_equal(pslg.attributes[5], [5, -5])
        self.assertEqual(pslg.holes.shape, (0, 2))

    def test_names(self):
        names = {"marker_names": {1: "inlet", -7: "Überlauf"}, "region_names": {7: "land", 8.5: "sea"}}
        pslg = driftmesh.Pslg([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)], **names)
        for value in (pslg, driftmesh.mesh(pslg), driftmesh.Mesh(pslg.points, [(0, 1, 2)], **names)):
            self.assertEqual((value.marker_names, value.region_names), tuple(names.values()))
        with self.assertRaisesRegex(driftmesh.InputError, "'land' is given twice"):
            driftmesh.mesh(driftmesh.Pslg([(0, 0), (1, 0), (0, 1)], marker_names={1: "land", 2: "land"}))

    def test_mesh(self):
        mesh = driftmesh.mesh(domain())
        count, triangles, edges = len(mesh.points), len(mesh.triangles), len(mesh.edges)
        self.assertEqual({name: getattr(mesh, name).shape for name in MESH_VIEWS},
                         {"points": (count, 2), "triangles": (triangles, 3), "edges": (edges, 2), "edge_markers": (edges,),
                          "point_markers": (count,), "attributes": (count, 2), "regions": (triangles,), "numbers": (0,),
                          "subdomains": (0,), "ranks": (0,)})
        self.assertEqual(set(mesh.regions), {7, 8})
        centers = mesh.points[mesh.triangles].mean(axis=1)
        np.testing.assert_array_equal(mesh.regions == 8, centers[:, 0] > 1)
        np.testing.assert_array_equal(mesh.attributes[:, 1], -mesh.attributes[:, 0])
        middle = mesh.points[mesh.edges[mesh.edge_markers == 9]]
        np.testing.assert_array_equal(middle[:, :, 0], 1)

    def test_types(self):
        mesh = driftmesh.mesh(domain())
        for name, kind in (("points", np.float64), ("triangles", np.int32), ("edges", np.int32), ("regions", np.float64),
                           ("numbers", np.int64)):
            self.assertEqual(getattr(mesh, name).dtype, kind, name)

    def test_round_trip_by_arrays(self):
        mesh = driftmesh.mesh(domain(), max_area=0.01)
        again = driftmesh.Mesh(mesh.points, mesh.triangles, edges=mesh.edges, edge_markers=mesh.edge_markers,
                               point_markers=mesh.point_markers, attributes=mesh.attributes, regions=mesh.regions)
        for name in MESH_VIEWS:
            np.testing.assert_array_equal(getattr(again, name), getattr(mesh, name), name)
        self.assertTrue(driftmesh.check(again, domain()))

    def test_nothing_at_all(self):
        mesh = driftmesh.Mesh([], [])
        for name in MESH_VIEWS:
            self.assertEqual(getattr(mesh, name).size, 0, name)


class Memory(unittest.TestCase):
    def test_nothing_is_copied(self):
        for whole, names in ((driftmesh.mesh(domain()), MESH_VIEWS), (domain(), DOMAIN_VIEWS)):
            for name in names:
                one, other = getattr(whole, name), getattr(whole, name)
                if one.size > 0:
                    self.assertTrue(np.shares_memory(one, other), name)
                    self.assertIs(one.base, whole, name)

    def test_arrays_are_read_only(self):
        for whole, names in ((driftmesh.mesh(domain()), MESH_VIEWS), (domain(), DOMAIN_VIEWS)):
            for name in names:
                array = getattr(whole, name)
                with self.assertRaises(ValueError, msg=name):
                    array[...] = 0
                if array.size > 0:
                    with self.assertRaises(ValueError, msg=name):
                        array.setflags(write=True)

    def test_arrays_outlive_the_variable(self):
        """The mesh is deleted first; its memory would have been used anew by the meshes made after it."""
        mesh = driftmesh.mesh(domain(), max_area=1e-3)
        views = {name: getattr(mesh, name) for name in MESH_VIEWS}
        copies = {name: view.copy() for name, view in views.items()}
        del mesh
        gc.collect()
        others = [driftmesh.mesh(domain(), max_area=1e-3 + 1e-4 * k) for k in range(8)]
        for name, view in views.items():
            np.testing.assert_array_equal(view, copies[name], name)
        self.assertEqual(len(others), 8)

    def test_memory_ends_with_the_last_array(self):
        class Watched(driftmesh.Mesh):
            """Python can watch objects of its own classes."""

        mesh = Watched([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])
        alive = weakref.ref(mesh)
        points = mesh.points
        part = points[1:]
        del mesh, points
        gc.collect()
        self.assertIsNotNone(alive())
        np.testing.assert_array_equal(part, [(1, 0), (0, 1)])
        del part
        gc.collect()
        self.assertIsNone(alive())

    def test_histogram_outlives_its_report(self):
        mesh = driftmesh.mesh(domain())
        angles = driftmesh.check(mesh).angles
        gc.collect()
        self.assertEqual(angles.sum(), 3 * len(mesh.triangles))


if __name__ == "__main__":
    unittest.main(verbosity=2)

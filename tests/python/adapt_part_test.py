"""Parts of meshes made anew, with numpy."""

import unittest

import driftmesh
import numpy as np

PLATE = driftmesh.generate("rectangle-hole")


def square(*more):
    points = [(0, 0), (4, 0), (4, 3), (0, 3)]
    segments = [(0, 1), (1, 2), (2, 3), (3, 0)]
    for k in range(len(more)):
        segments.append((4 + k, 4 + (k + 1) % len(more)))
    return driftmesh.Pslg(points + list(more), segments, holes=[np.mean(more, axis=0)] if more else [])


class AdaptPart(unittest.TestCase):
    def assert_stays(self, before, after):
        stays, same = after.old_points >= 0, after.old_triangles >= 0
        np.testing.assert_array_equal(after.mesh.points[stays], before.points[after.old_points[stays]])
        np.testing.assert_array_equal(after.old_points[after.mesh.triangles[same]], before.triangles[after.old_triangles[same]])
        self.assertEqual(len(set(after.old_points[stays])), stays.sum())
        return same.sum()

    def test_a_part(self):
        mesh = driftmesh.mesh(PLATE, max_area=0.001)
        inside = np.flatnonzero((mesh.points[mesh.triangles].mean(axis=1) < 0.2).all(axis=1))
        after = driftmesh.adapt_part(mesh, inside, longest=0.02)
        self.assertTrue(driftmesh.check(after.mesh, PLATE))
        self.assertGreater(self.assert_stays(mesh, after), len(mesh.triangles) / 2)
        self.assertGreater(len(after.mesh.triangles), len(mesh.triangles))
        self.assertGreaterEqual(after.margin, 0)
        self.assertGreaterEqual(after.margin_width, 0)

    def test_lengths(self):
        mesh = driftmesh.mesh(PLATE, max_area=0.001)
        everything = np.arange(len(mesh.triangles))
        fine, coarse = (driftmesh.adapt_part(mesh, everything, lengths=np.full(len(mesh.points), h)).mesh for h in (0.02, 0.2))
        self.assertGreater(len(fine.triangles), 2 * len(coarse.triangles))

    def test_an_outline(self):
        mesh = driftmesh.mesh(square(), max_area=0.01)
        island = square((1, 1), (1.5, 1), (1.5, 1.5), (1, 1.5))
        after = driftmesh.adapt_outline(mesh, island)
        self.assertTrue(driftmesh.check(after.mesh, island))
        self.assertGreater(self.assert_stays(mesh, after), len(mesh.triangles) / 2)
        self.assertEqual(after.beyond, 0)
        back = driftmesh.adapt_outline(after.mesh, square())
        self.assertTrue(driftmesh.check(back.mesh, square()))
        self.assertGreater(back.beyond, 0)
        same = driftmesh.adapt_outline(mesh, square())
        np.testing.assert_array_equal(same.old_triangles, np.arange(len(mesh.triangles)))

    def test_point_data(self):
        mesh = driftmesh.mesh(square(), max_area=0.02)
        x, y = mesh.points.T
        data = driftmesh.Mesh(mesh.points, mesh.triangles, edges=mesh.edges, attributes=3 * x - y)
        after = driftmesh.adapt_outline(data, square((1, 1), (1.5, 1), (1.5, 1.5), (1, 1.5)))
        x, y = after.mesh.points.T
        np.testing.assert_allclose(after.mesh.attributes[:, 0], 3 * x - y, atol=1e-12)

    def test_errors(self):
        mesh = driftmesh.mesh(square(), max_area=0.1)
        for wrong in ([-1], [len(mesh.triangles)]):
            with self.assertRaisesRegex(driftmesh.Error, "there is no triangle"):
                driftmesh.adapt_part(mesh, wrong)
        with self.assertRaisesRegex(driftmesh.Error, "lengths for"):
            driftmesh.adapt_part(mesh, [0], lengths=[1.0])
        with self.assertRaisesRegex(driftmesh.Error, "conserve"):
            driftmesh.adapt_part(mesh, [0], conserve=["heat"])
        with self.assertRaisesRegex(driftmesh.Error, "min_angle is 50"):
            driftmesh.adapt_part(mesh, [0], min_angle=50)
        for wrong, text in (({"longest": 0}, "^longest is 0; .* not below shortest, which is 0$"), ({"gradation": -1e-9}, "^gradation is -1e-09;"),
                            ({"conserve": ["heat"]}, "'heat', which conserve names")):
            with self.assertRaisesRegex(driftmesh.Error, text):
                driftmesh.adapt_part(mesh, [0], **wrong)
        heat = np.ones(len(mesh.points))
        heat[3] = np.nan
        data = driftmesh.Mesh(mesh.points, mesh.triangles, edges=mesh.edges, attributes=heat)
        with self.assertRaisesRegex(driftmesh.Error, "'attribute' is nan at point 3"):
            driftmesh.adapt_part(data, [0], conserve=["attribute"])
        with self.assertRaises(driftmesh.LimitError):
            driftmesh.adapt_part(mesh, range(len(mesh.triangles)), longest=0.01, most_triangles=100)
        with self.assertRaises(driftmesh.InputError):
            driftmesh.adapt_outline(mesh, driftmesh.Pslg([(0, 0), (1, 1)], []))


if __name__ == "__main__":
    unittest.main()

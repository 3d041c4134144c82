"""Reading, writing and converting."""

import pathlib
import tempfile
import unittest

import driftmesh
import numpy as np

PLATE = driftmesh.generate("rectangle-hole")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_domains(self):
        path = self.folder / "plate.poly"
        PLATE.write(path)
        for again in (driftmesh.read(path), driftmesh.read_poly(str(path))):
            np.testing.assert_array_equal(again.points, PLATE.points)
            np.testing.assert_array_equal(again.segments, PLATE.segments)
            np.testing.assert_array_equal(again.holes, PLATE.holes)

    def test_meshes(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-3)
        for name in ("plate.vtu", "plate.msh", "plate.1.ele"):
            mesh.write(self.folder / name)
            again = driftmesh.read(self.folder / name)
            np.testing.assert_array_equal(again.points, mesh.points)
            np.testing.assert_array_equal(again.triangles, mesh.triangles)
            self.assertTrue(driftmesh.check(again, PLATE, max_area=1e-3), name)

    def test_outlines_of_meshes(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-2)
        mesh.write(self.folder / "plate.vtu")
        for outline in (driftmesh.outline(mesh), driftmesh.read_input(self.folder / "plate.vtu")):
            self.assertEqual(len(outline.holes), 1)
            anew = driftmesh.mesh(outline, max_area=1e-3)
            self.assertGreater(len(anew.triangles), len(mesh.triangles))
            self.assertEqual(set(anew.edge_markers), set(mesh.edge_markers))
            self.assertTrue(driftmesh.check(anew, PLATE, max_area=1e-3))

    def test_outlines_with_gaps_and_without_a_border(self):
        corners = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0.1)]
        line = driftmesh.Pslg(corners, [(0, 1), (1, 2), (2, 3), (3, 4)])
        with self.assertRaisesRegex(driftmesh.Error, "0.1 apart"):
            driftmesh.mesh(line)
        self.assertTrue(driftmesh.check(driftmesh.mesh(line, snap=0.2), line, snap=0.2))
        notch = driftmesh.Pslg([(0, 0), (4, 0), (4, 4), (2, 1)], [(0, 1), (1, 2), (2, 3)])
        self.assertTrue(driftmesh.check(driftmesh.mesh(notch, hull=True), notch, hull=True))

    def test_a_node_file_alone_is_a_domain(self):
        driftmesh.mesh(PLATE).write(self.folder / "plate.node")
        self.assertIsInstance(driftmesh.read(self.folder / "plate.node"), driftmesh.Mesh)
        (self.folder / "plate.ele").unlink()
        self.assertIsInstance(driftmesh.read(self.folder / "plate.node"), driftmesh.Pslg)

    def test_decompositions(self):
        cut = driftmesh.cut_domain(PLATE, 2, max_area=1e-3, subdomains={"count": 6})
        self.assertEqual(len(cut), 6)
        cut.write(PLATE, self.folder / "plate.cut")
        again = driftmesh.read_decomposition(self.folder / "plate.cut", PLATE)
        one, other = (driftmesh.mesh(PLATE, max_area=1e-3, subdomains={"given": given}) for given in (cut, again))
        self.assertEqual(set(one.subdomains), set(range(6)))
        np.testing.assert_array_equal(one.triangles, other.triangles)
        with self.assertRaises(driftmesh.InputError):
            driftmesh.read_decomposition(self.folder / "plate.cut", driftmesh.generate("fan"))
        with self.assertRaisesRegex(TypeError, "Decomposition"):
            driftmesh.mesh(PLATE, subdomains={"given": 6})

    def test_convert(self):
        mesh = driftmesh.mesh(PLATE)
        mesh.write(self.folder / "plate.vtu")
        driftmesh.convert(self.folder / "plate.vtu", self.folder / "plate.msh")
        np.testing.assert_array_equal(driftmesh.read(self.folder / "plate.msh").triangles, mesh.triangles)


if __name__ == "__main__":
    unittest.main(verbosity=2)

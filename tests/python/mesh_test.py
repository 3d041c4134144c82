"""Generating, meshing and checking, and the options of all of them."""

import inspect
import unittest

import driftmesh
import numpy as np

PLATE = driftmesh.generate("rectangle-hole")


def areas(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


class Generate(unittest.TestCase):
    def test_every_input_can_be_meshed(self):
        for name in driftmesh.generator_names():
            few = {"random-points": {"points": 500, "segments": 50}, "random-polygon": {"vertices": 100},
                   "bay": {"resolution": 1000}}.get(name, {})
            domain = driftmesh.generate(name, **few)
            self.assertGreater(len(domain.points), 3, name)
            self.assertTrue(driftmesh.check(driftmesh.mesh(domain), domain), name)

    def test_parameters(self):
        fan = driftmesh.generate("fan", wedges=5, angle=2.5, corner=True)
        self.assertEqual(np.count_nonzero(fan.segment_markers == 2), 6)
        self.assertEqual(len(driftmesh.generate("pipe", channels=3).holes), 4)
        coarse, fine = (driftmesh.generate("cylinder_flow", arc_edges=n) for n in (16, 64))
        self.assertEqual(len(fine.points) - len(coarse.points), 48)


class Options(unittest.TestCase):
    def test_bounds(self):
        mesh = driftmesh.mesh(PLATE, min_angle=30, max_area=1e-3)
        self.assertLessEqual(areas(mesh).max(), 1e-3)
        self.assertGreater(areas(mesh).min(), 0)
        report = driftmesh.check(mesh, PLATE, min_angle=30, max_area=1e-3)
        self.assertTrue(report.accepted, report)
        self.assertGreaterEqual(report.smallest_angle, 30)
        self.assertAlmostEqual(report.area, areas(mesh).sum(), places=12)

    def test_numbers_as_in_files(self):
        self.assertEqual(len(driftmesh.mesh(PLATE, triangles="5k", max_memory="2G").triangles),
                         len(driftmesh.mesh(PLATE, triangles=5000).triangles))

    def test_sections_and_choices(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-3, subdomains={"count": 7, "order": "largest", "presplit": "on"})
        self.assertEqual(set(mesh.subdomains), set(range(7)))
        self.assertEqual(len(driftmesh.mesh(PLATE).subdomains), 0)

    def test_none_is_the_default(self):
        self.assertEqual(len(driftmesh.mesh(PLATE, max_area=None, size=None, progress=None).triangles),
                         len(driftmesh.mesh(PLATE).triangles))

    def test_polygons(self):
        points = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (4, 2), (1, 2)]  # a hole over the edge
        rings = [0, 1, 2, 3], [4, 5, 6, 7]
        sides = [(ring[k], ring[(k + 1) % 4]) for ring in rings for k in range(4)]
        domain = driftmesh.Pslg(points, sides, polygons=[(rings, 0, 4)], regions=[(0, 0, 7, 0)])
        (read, region, feature), = domain.polygons
        self.assertEqual(([list(ring) for ring in read], region, feature), (list(rings), 0, 4))
        with self.assertWarnsRegex(driftmesh.InputWarning, "a hole of feature 4 reaches outside"):
            mesh = driftmesh.mesh(domain)
        self.assertAlmostEqual(areas(mesh).sum(), 9 - 1.75)
        self.assertEqual(set(mesh.regions), {7})
        for wrong, error in (([7], TypeError), ([(rings, 0, 1, 2)], TypeError), ([([[0, 99]],)], ValueError)):
            with self.assertRaises(error):
                driftmesh.Pslg(points, sides, polygons=wrong)
        with self.assertRaisesRegex(driftmesh.InputError, "an edge that is no segment"):
            driftmesh.mesh(driftmesh.Pslg(points, sides, polygons=[([[0, 1, 2]],)]))

    def test_holes(self):
        rings = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)]
        sides = [(k, (k + 1) % 4) for k in range(4)] + [(4 + k, 4 + (k + 1) % 4) for k in range(4)]
        domain = driftmesh.Pslg(rings, sides)
        self.assertAlmostEqual(areas(driftmesh.mesh(domain, holes="nested")).sum(), 8)
        with self.assertWarns(driftmesh.InputWarning):
            self.assertAlmostEqual(areas(driftmesh.mesh(domain)).sum(), 9)

    def test_simplified(self):
        domain = driftmesh.generate("bay", resolution=400)
        mesh = driftmesh.mesh(domain, simplify=1000)
        self.assertLess(len(mesh.points), len(driftmesh.mesh(domain).points) / 2)
        self.assertTrue(driftmesh.check(mesh, domain, simplify=1000))
        self.assertFalse(driftmesh.check(mesh, domain))

    def test_every_option_of_the_table_is_taken(self):
        """With its own default, which changes nothing."""
        expected = driftmesh.mesh(PLATE).points
        for option in driftmesh.option_table():
            section, _, name = option["name"].rpartition(".")
            value = option["default"]
            options = {section: {name: value}} if section else {name: value}
            np.testing.assert_array_equal(driftmesh.mesh(PLATE, **options).points, expected, option["name"])

    def test_documentation_names_every_option(self):
        for function in (driftmesh.mesh, driftmesh.check):
            for option in driftmesh.option_table():
                self.assertIn(option["name"] + " (", inspect.getdoc(function))


class Check(unittest.TestCase):
    def test_flaws_are_reported(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-2)
        triangles = mesh.triangles.copy()
        triangles[3] = triangles[3][::-1]
        report = driftmesh.check(driftmesh.Mesh(mesh.points, triangles, edges=mesh.edges), PLATE)
        self.assertFalse(report)
        found = {finding.kind: finding for finding in report.findings}
        self.assertEqual(found["not counterclockwise"].count, 1, report)
        self.assertIn("3", found["not counterclockwise"].examples[0])
        self.assertTrue(report.verdict.startswith("rejected"), report.verdict)

    def test_bounds_that_are_not_met(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-2)
        self.assertTrue(driftmesh.check(mesh))
        self.assertFalse(driftmesh.check(mesh, max_area=1e-3))
        self.assertFalse(driftmesh.check(mesh, size=lambda x, y: 0.05, size_resolution=100))
        self.assertFalse(driftmesh.check(mesh, driftmesh.generate("rectangle-hole", radius=0.2)))

    def test_report(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-2)
        report = driftmesh.check(mesh, PLATE, max_area=1e-2)
        self.assertEqual((report.points, report.triangles, report.subsegments),
                         (len(mesh.points), len(mesh.triangles), len(mesh.edges)))
        self.assertEqual(report.angles.sum(), 3 * len(mesh.triangles))
        self.assertEqual(report.exceptions, 0)
        self.assertLess(report.largest_angle, 140)
        self.assertEqual([report.smallest_area, report.largest_area], [areas(mesh).min(), areas(mesh).max()])
        self.assertIn(report.verdict, str(report))


if __name__ == "__main__":
    unittest.main(verbosity=2)

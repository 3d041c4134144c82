"""The calls of the packages triangle, MeshPy and cytriangle: the examples of their documentation with another import, what their
documentation promises, and random inputs judged by code of this file and by driftmesh.check."""

import os
import pathlib
import pickle
import random
import tempfile
import unittest
from fractions import Fraction

import driftmesh
import driftmesh.cytriangle as cytriangle
import driftmesh.meshpy.triangle as meshpy_triangle
import driftmesh.triangle as tr
import numpy as np

SEED = int(os.environ.get("DRIFTMESH_SEED", random.SystemRandom().randrange(2**32)))
SQUARE = dict(vertices=[[0, 0], [0, 1], [1, 1], [1, 0]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])


def corners(mesh):
    return np.moveaxis(mesh["vertices"][mesh["triangles"][:, :3]], 1, 0)


def areas(mesh):
    a, b, c = corners(mesh)
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def smallest_angle(mesh):
    least = 180
    points = corners(mesh)
    for i in range(3):
        u, v = points[(i + 1) % 3] - points[i], points[(i + 2) % 3] - points[i]
        least = min(least, np.degrees(np.arctan2(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), (u * v).sum(1))).min())
    return least


def inside_circumcircle(a, b, c, p):
    """Whether p lies inside the circle through a, b, c, which turn left: exactly, by rational numbers."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(q[k]) - Fraction(p[k]) for k in range(2)] for q in (a, b, c))
    return (ax ** 2 + ay ** 2) * (bx * cy - cx * by) + (bx ** 2 + by ** 2) * (cx * ay - ax * cy) \
        + (cx ** 2 + cy ** 2) * (ax * by - bx * ay) > 0


def is_delaunay(mesh):
    """Whether no point lies inside a circumcircle: far points by floating point, those near a circle exactly."""
    a, b, c = corners(mesh)
    used = mesh["vertices"][np.unique(mesh["triangles"][:, :3])]
    u, v = b - a, c - a
    squares = np.stack([(u ** 2).sum(1), (v ** 2).sum(1)])
    center = np.stack([squares[0] * v[:, 1] - squares[1] * u[:, 1], squares[1] * u[:, 0] - squares[0] * v[:, 0]], 1)
    center /= 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[:, None]
    radius = (center ** 2).sum(1)
    distance = ((used[None] - a[:, None] - center[:, None]) ** 2).sum(2)
    near = np.argwhere(distance < radius[:, None] * (1 + 1e-6))
    return not any(inside_circumcircle(a[t], b[t], c[t], used[p]) for t, p in near)


def as_mesh(tables):
    segments = tables.get("segments", np.empty((0, 2), np.int32))
    return driftmesh.Mesh(tables["vertices"], tables["triangles"][:, :3], edges=segments if len(segments) else None)


def random_pslg(generator):
    """A ring around a few holes, regions and loose points, with markers and attributes."""
    count = generator.randrange(5, 40)
    angle = np.sort(generator.random() + np.arange(count) * 2 * np.pi / count)
    radius = np.array([generator.uniform(4, 6) for _ in range(count)])
    rings = [np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)]
    holes = []
    for center in [(-1.5, 0), (1.5, 0.5)][:generator.randrange(3)]:
        turn = np.arange(generator.randrange(3, 9))
        turn = turn * 2 * np.pi / len(turn)
        rings.append(np.stack([center[0] + 0.8 * np.cos(turn), center[1] + 0.8 * np.sin(turn)], 1))
        holes.append(center)
    loose = np.array([(generator.uniform(-1, 1), generator.uniform(-3, -1.2)) for _ in range(generator.randrange(6))])
    vertices = np.concatenate(rings + [loose.reshape(-1, 2)])
    segments, first = [], 0
    for ring in rings:
        segments += [(first + i, first + (i + 1) % len(ring)) for i in range(len(ring))]
        first += len(ring)
    tables = dict(vertices=vertices, segments=np.array(segments), vertex_attributes=np.arange(len(vertices) * 2.0).reshape(-1, 2),
                  segment_markers=np.array([generator.randrange(4) for _ in segments])[:, None])
    if holes:
        tables["holes"] = np.array(holes)
    return tables


class Triangulate(unittest.TestCase):
    def test_example_of_the_page(self):
        mesh = tr.triangulate(dict(vertices=SQUARE["vertices"]), "a0.2")
        self.assertEqual(mesh["vertices"][:4].tolist(), [[0, 0], [0, 1], [1, 1], [1, 0]])
        self.assertEqual(mesh["vertex_markers"][:4].tolist(), [[1]] * 4)
        self.assertLessEqual(areas(mesh).max(), 0.2)
        self.assertAlmostEqual(areas(mesh).sum(), 1)

    def test_types_and_shapes(self):
        mesh = tr.triangulate(dict(SQUARE, vertex_attributes=[1, 2, 3, 4], regions=[[0.5, 0.5, 7, 0.1]], holes=np.empty((0, 2))),
                              "pqaAnev")
        n, t = len(mesh["vertices"]), len(mesh["triangles"])
        for name, shape, kind in [
                ("vertices", (n, 2), np.float64), ("vertex_attributes", (n, 1), np.float64), ("vertex_markers", (n, 1), np.int32),
                ("triangles", (t, 3), np.int32), ("triangle_attributes", (t, 1), np.float64), ("neighbors", (t, 3), np.int32),
                ("segments", (len(mesh["segments"]), 2), np.int32), ("segment_markers", (len(mesh["segments"]), 1), np.int32),
                ("edges", (n + t - 1, 2), np.int32), ("edge_markers", (n + t - 1, 1), np.int32), ("regions", (1, 4), np.float64)]:
            self.assertEqual((mesh[name].shape, mesh[name].dtype), (shape, np.dtype(kind)), name)
        self.assertNotIn("holes", mesh)
        self.assertTrue((mesh["triangle_attributes"] == 7).all())
        self.assertEqual(len(mesh["voronoi"]["vertices"]), t)

    def test_what_is_returned(self):
        self.assertEqual(set(tr.triangulate(SQUARE)), {"vertices", "vertex_markers", "triangles"})
        self.assertEqual(set(tr.triangulate(SQUARE, "p")), {"vertices", "vertex_markers", "triangles", "segments", "segment_markers"})
        self.assertEqual(set(tr.triangulate(SQUARE, "pBP")), {"vertices", "triangles"})
        self.assertEqual(set(tr.triangulate(SQUARE, "pNE")), {"segments", "segment_markers"})
        self.assertEqual(set(tr.triangulate(SQUARE, "c")), set(tr.triangulate(SQUARE, "p")))

    def test_regions(self):
        square = np.array([[0, 0], [5, 0], [5, 5], [0, 5], [1, 1], [2, 1], [2, 2], [1, 2]])
        ring = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
        tables = dict(vertices=square, segments=np.concatenate([ring, ring + 4]), regions=[[1.5, 1.5, 8, 0.01], [3, 3, 9, 0]])
        mesh = tr.triangulate(tables, "pqAa")
        inner = (np.abs(np.mean(corners(mesh), 0) - 1.5) < 0.5).all(1)
        self.assertEqual(set(mesh["triangle_attributes"][inner, 0]), {8})
        self.assertEqual(set(mesh["triangle_attributes"][~inner, 0]), {9})
        self.assertLessEqual(areas(mesh)[inner].max(), 0.01)
        self.assertGreater(areas(mesh)[~inner].max(), 0.01)
        self.assertLessEqual(areas(tr.triangulate(tables, "pqAaa0.5")).max(), 0.5)
        self.assertEqual(len(tr.triangulate(tables, "pqA")["regions"]), 2)
        del tables["regions"]
        self.assertNotIn("triangle_attributes", tr.triangulate(tables, "pA"))

    def test_markers(self):
        tables = dict(SQUARE, segment_markers=[5, 0, 6, 0], vertex_markers=[0, 9, 0, 0])
        tables["vertices"] = [*SQUARE["vertices"], [0.2, 0.5], [0.8, 0.5]]
        tables["segments"] = [*SQUARE["segments"], [4, 5]]
        tables["segment_markers"] = [5, 0, 6, 0, 7]
        tables["vertex_markers"] = [0, 9, 0, 0, 0, 0]
        mesh = tr.triangulate(tables, "pq30a0.01e")
        x, y = mesh["vertices"].T
        marker = mesh["vertex_markers"][:, 0]
        inside = (x > 0) & (x < 1) & (y > 0) & (y < 1)
        on_wall = inside & (y == 0.5) & (x >= 0.2) & (x <= 0.8)
        for where, wanted in [((x == 0) & (y < 1), 5), ((x == 0) & (y == 1), 9), ((y == 1) & (x > 0) & (x < 1), 1), (x == 1, 6),
                              ((y == 0) & (x > 0) & (x < 1), 1), (on_wall, 7), (inside & ~on_wall, 0)]:
            self.assertEqual(set(marker[where]), {wanted})
        edge_markers = mesh["edge_markers"][:, 0]
        self.assertEqual(set(edge_markers), {0, 1, 5, 6, 7})
        self.assertEqual(sum(edge_markers > 0), len(mesh["segments"]))
        self.assertEqual(sorted(edge_markers[edge_markers > 0]), sorted(mesh["segment_markers"][:, 0]))

    def test_points_stay_without_bounds(self):
        generator = random.Random(SEED)
        for switches in ("p", "pc", "", "c", "pO", "pY", "pi", "pF", "pl", "pX"):
            with self.subTest(seed=SEED, switches=switches):
                tables = random_pslg(generator)
                mesh = tr.triangulate(tables, switches)
                np.testing.assert_array_equal(mesh["vertices"], tables["vertices"])
                np.testing.assert_array_equal(mesh["vertex_attributes"], tables["vertex_attributes"])

    def test_random_inputs(self):
        generator = random.Random(SEED)
        for switches, angle, area in [("p", 0, 0), ("pq", 20, 0), ("pq33a0.05", 33, 0.05), ("pq30a0.1D", 30, 0.1), ("pD", 0, 0),
                                      ("ps", 0, 0), ("pa0.3", 0, 0.3), ("pq25Y", 25, 0), ("pqYYa0.05", 0, 0.05), ("pqS20", 0, 0),
                                      ("pjC", 0, 0), ("pcq", 0, 0)]:
            with self.subTest(seed=SEED, switches=switches):
                tables = random_pslg(generator)
                mesh = tr.triangulate(tables, switches)
                given = len(tables["vertices"])
                if "j" not in switches:
                    np.testing.assert_array_equal(mesh["vertices"][:given], tables["vertices"])
                report = driftmesh.check(as_mesh(mesh), min_angle=0)
                self.assertTrue(report.accepted, report.text)
                if "c" not in switches:
                    self.assert_covers(mesh, tables)
                if area:
                    self.assertLessEqual(areas(mesh).max(), area * (1 + 1e-9))
                if angle and "Y" not in switches:
                    allowed = driftmesh.check(as_mesh(mesh), self.pslg(tables), min_angle=angle, max_area=area or None)
                    self.assertTrue(allowed.accepted, allowed.text)
                if "D" in switches or "s" in switches:
                    self.assertTrue(is_delaunay(mesh))
                if "S" in switches:
                    self.assertLessEqual(len(mesh["vertices"]), given + 20)
                if "YY" in switches:
                    self.assertEqual(len(mesh["segments"]), len(tables["segments"]))

    def assert_covers(self, mesh, tables):
        ring = tables["vertices"][tables["segments"]]
        signed = (ring[:, 0, 0] * ring[:, 1, 1] - ring[:, 0, 1] * ring[:, 1, 0]) / 2
        outer = len(tables["segments"])
        starts = np.flatnonzero(np.diff(tables["segments"][:, 0]) < 0)
        holes = 0
        first = 0
        while first < outer:
            last = first + np.flatnonzero(tables["segments"][first:, 1] == tables["segments"][first, 0])[0] + 1
            if first > 0:
                holes += signed[first:last].sum()
            else:
                whole = signed[:last].sum()
            first = last
        self.assertAlmostEqual(areas(mesh).sum(), whole - holes, places=9, msg=str(starts))

    @staticmethod
    def pslg(tables):
        return driftmesh.Pslg(tables["vertices"], tables["segments"], segment_markers=np.zeros(len(tables["segments"]), int),
                              holes=tables.get("holes"))

    def test_nothing_on_the_boundary(self):
        """Y keeps boundary segments whole, but not those inside; YY keeps all."""
        tables = dict(SQUARE, vertices=[*SQUARE["vertices"], [0.1, 0.49], [0.9, 0.52], [0.12, 0.5], [0.88, 0.51]],
                      segments=[*SQUARE["segments"], [4, 5]])
        for switches, inside in (("pq30Ya0.001", True), ("pq30YYa0.001", False)):
            mesh = tr.triangulate(tables, switches + "e")
            x, y = mesh["vertices"].T
            self.assertEqual(((x == 0) | (x == 1) | (y == 0) | (y == 1)).sum(), 4)
            self.assertEqual(len(mesh["segments"]) > 5, inside)
            self.assertLessEqual(areas(mesh).max(), 0.001)

    def test_acute_corners_conform(self):
        generator = random.Random(SEED)
        for _ in range(6):
            rays = np.sort([generator.uniform(0, 1.4) for _ in range(generator.randrange(2, 7))])
            ends = np.array([(generator.uniform(0.3, 1.5) * np.cos(a), generator.uniform(0.3, 1.5) * np.sin(a)) for a in rays])
            box = [[-0.5, -0.5], [2, -0.5], [2, 2], [-0.5, 2]]
            tables = dict(vertices=[*box, [0, 0], *ends], segments=[[0, 1], [1, 2], [2, 3], [3, 0],
                                                                    *([4, 5 + i] for i in range(len(ends)))])
            with self.subTest(seed=SEED, ends=ends.tolist()):
                mesh = tr.triangulate(tables, "pDq20")
                self.assertTrue(is_delaunay(mesh))
                self.assertTrue(is_delaunay(tr.triangulate(tables, "pD")))

    def test_neighbors_edges_and_voronoi(self):
        mesh = tr.triangulate(dict(vertices=np.random.RandomState(SEED).uniform(size=(200, 2))), "nev")
        triangles, neighbors = mesh["triangles"], mesh["neighbors"]
        for t, row in enumerate(neighbors):
            for i, other in enumerate(row):
                if other >= 0:
                    shared = {triangles[t][(i + 1) % 3], triangles[t][(i + 2) % 3]}
                    self.assertTrue(shared <= set(triangles[other]))
                    self.assertIn(t, neighbors[other])
        self.assertEqual(len(mesh["edges"]), 200 + len(triangles) - 1)
        self.assertEqual((mesh["edge_markers"] == 1).sum(), (neighbors < 0).sum())
        diagram = mesh["voronoi"]
        for t, center in enumerate(diagram["vertices"]):
            distance = np.hypot(*(mesh["vertices"][triangles[t]] - center).T)
            np.testing.assert_allclose(distance, distance[0], rtol=1e-6)
        self.assertEqual(len(diagram["edges"]) + len(diagram["ray_origins"]), len(mesh["edges"]))
        self.assertEqual(len(diagram["ray_origins"]), (neighbors < 0).sum())

    def test_second_order(self):
        mesh = tr.triangulate(dict(SQUARE, vertex_attributes=[0, 1, 2, 1]), "pq30a0.05o2e")
        points, six = mesh["vertices"], mesh["triangles"]
        self.assertEqual(six.shape[1], 6)
        for i in range(3):
            np.testing.assert_array_equal(points[six[:, 3 + i]], (points[six[:, (i + 1) % 3]] + points[six[:, (i + 2) % 3]]) / 2)
        self.assertEqual(len(points), six[:, :3].max() + 1 + len(mesh["edges"]))
        np.testing.assert_allclose(mesh["vertex_attributes"][:, 0], points.sum(1), atol=1e-12)
        boundary = (points == 0).any(1) | (points == 1).any(1)
        np.testing.assert_array_equal(mesh["vertex_markers"][:, 0], boundary)

    def test_jettison_and_duplicates(self):
        tables = dict(SQUARE, vertices=[*SQUARE["vertices"], [3, 3], [0.5, 0.5], [0.5, 0.5]])
        kept = tr.triangulate(tables, "p")
        self.assertEqual(len(kept["vertices"]), 7)
        self.assertEqual(set(kept["triangles"].ravel()), {0, 1, 2, 3, 5})
        left = tr.triangulate(tables, "pj")
        self.assertEqual(left["vertices"].tolist(), [[0, 0], [0, 1], [1, 1], [1, 0], [0.5, 0.5]])
        self.assertEqual(set(left["triangles"].ravel()), set(range(5)))

    def test_crossings(self):
        tables = dict(vertices=[[0, 0], [2, 0], [2, 2], [0, 2]], segments=[[0, 2], [1, 3], [0, 1], [1, 2], [2, 3], [3, 0]])
        mesh = tr.triangulate(tables, "p")
        self.assertEqual(mesh["vertices"][4:].tolist(), [[1, 1]])

    def test_refine(self):
        coarse = tr.triangulate(dict(SQUARE, regions=[[0.5, 0.5, 3, 0]]), "pq30a0.1A")
        fine = tr.triangulate(coarse, "rpq30a0.01")
        np.testing.assert_array_equal(fine["vertices"][:len(coarse["vertices"])], coarse["vertices"])
        self.assertLessEqual(areas(fine).max(), 0.01)
        self.assertGreaterEqual(smallest_angle(fine), 30 - 1e-9)
        self.assertTrue((fine["triangle_attributes"] == 3).all())
        self.assertEqual(set(tr.triangulate(coarse, "r")), set(coarse) - {"segments", "segment_markers", "regions"})
        same = tr.triangulate(coarse, "rp")
        self.assertEqual({tuple(sorted(t)) for t in same["triangles"].tolist()},
                         {tuple(sorted(t)) for t in coarse["triangles"].tolist()})

    def test_refine_by_areas(self):
        """Holes, islands in holes, and parts that touch at a point stay what they are; attributes go with their triangles."""
        generator = random.Random(SEED)
        for _ in range(5):
            tables = random_pslg(generator)
            with self.subTest(seed=SEED):
                coarse = tr.triangulate(tables, "pq20a0.5")
                count = len(coarse["triangles"])
                bounds = np.array([generator.choice([-1, 0.1, 0.02]) for _ in range(count)])
                coarse |= dict(triangle_max_area=bounds, triangle_attributes=np.stack([np.arange(count), bounds], 1))
                fine = tr.triangulate(coarse, "rpqa")
                np.testing.assert_array_equal(fine["vertices"][:len(coarse["vertices"])], coarse["vertices"])
                self.assertAlmostEqual(areas(fine).sum(), areas(coarse).sum())
                bound = fine["triangle_attributes"][:, 1]
                self.assertTrue((areas(fine)[bound > 0] <= bound[bound > 0] * (1 + 1e-9)).all())
                self.assertTrue(driftmesh.check(as_mesh(fine), min_angle=0).accepted)
                centers, old = np.mean(corners(fine), 0), np.stack(corners(coarse), 1)[fine["triangle_attributes"][:, 0].astype(int)]
                for i in range(3):
                    u, v = old[:, (i + 1) % 3] - old[:, i], centers - old[:, i]
                    self.assertTrue((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] >= -1e-12).all())

    def test_refine_touching_parts(self):
        vertices = [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1], [5, 5], [6, 5], [5, 6]]
        mesh = dict(vertices=vertices, triangles=[[0, 1, 2], [0, 3, 4], [5, 7, 6]])  # the last one is clockwise
        fine = tr.triangulate(mesh, "ra0.02q")
        self.assertAlmostEqual(areas(fine).sum(), 1.5)
        self.assertGreater(areas(fine).min(), 0)
        self.assertEqual(fine["vertices"][:8].tolist(), vertices)

    def test_unsuitable(self):
        def too_large(points, area):
            x, y = np.mean(points, axis=0)
            return area > 0.001 + 0.02 * np.hypot(x, y)

        mesh = tr.triangulate(SQUARE, "pq30u", unsuitable=too_large)
        self.assertFalse(any(too_large(p, a) for p, a in zip(np.stack(corners(mesh), 1), areas(mesh))))
        self.assertGreaterEqual(smallest_angle(mesh), 30 - 1e-9)
        self.assertLess(len(mesh["triangles"]), 2000)
        self.assertLess(len(tr.triangulate(SQUARE, "pq30uS10", unsuitable=too_large)["vertices"]), 15)
        with self.assertRaises(ZeroDivisionError):
            tr.triangulate(SQUARE, "pu", unsuitable=lambda points, area: 1 / 0)
        with self.assertRaisesRegex(driftmesh.Error, "switch u"):
            tr.triangulate(SQUARE, "pu")

    def test_numbers_in_switches(self):
        self.assertLessEqual(areas(tr.triangulate(SQUARE, "pa.2q")).max(), 0.2)
        self.assertIn("edges", tr.triangulate(SQUARE, "pa0.2e"))
        self.assertLessEqual(areas(tr.triangulate(SQUARE, "pa5e-03")).max(), 0.005)
        self.assertLessEqual(areas(tr.triangulate(SQUARE, "-p -q30 -a0.1")).max(), 0.1)
        self.assertEqual(tr.triangulate(SQUARE, "po1")["triangles"].shape[1], 3)

    def test_refused(self):
        for switches, says in [("pk", "'pk'.*none of Triangle's|switch k"), ("pw", "switch w.*weighted"), ("pq40", "switch q.*34"),
                               ("pa0", "switch a"), ("po3", "switch o"), ("pa1..2", "switch a.*1..2"), ("pS1.5", "switch S"),
                               ("r", "triangles"), ("rI", "switch I")]:
            with self.subTest(switches=switches), self.assertRaisesRegex(driftmesh.Error, says):
                tr.triangulate(SQUARE, switches)
        for tables, says in [(dict(SQUARE, segments=[[0, 9]]), "segment 0"), (dict(SQUARE, vertex_markers=[1, 2]), "markers"),
                             (dict(SQUARE, vertices=[[0, 0], [1, 1], [2, 2], [3, 3]]), "line"), (dict(SQUARE, segments=[[0, 1]]), ""),
                             (dict(SQUARE, holes=[[0.5, 0.5]]), "hole")]:
            with self.subTest(tables=tables), self.assertRaisesRegex(driftmesh.Error, says):
                tr.triangulate(tables, "p")
        for tables in (dict(SQUARE, segments=[[0, 1, 2]]), dict(SQUARE, segments=[[0.5, 1]]), {}):
            with self.subTest(tables=tables), self.assertRaises(ValueError):
                tr.triangulate(tables, "p")
        with self.assertRaises(TypeError):
            tr.triangulate(dict(vertices=[["a", "b"]]))
        with self.assertRaisesRegex(driftmesh.Error, "areas"):
            tr.triangulate(tr.triangulate(SQUARE, "p"), "rpa")


class Helpers(unittest.TestCase):
    POINTS = [[0, 0], [0, 1], [0.5, 0.5], [1, 1], [1, 0]]

    def test_functions(self):
        self.assertEqual(len(tr.convex_hull([[0, 0], [0, 1], [1, 1], [1, 0]])), 4)
        hull = tr.convex_hull(self.POINTS)
        self.assertEqual({frozenset(s) for s in hull.tolist()}, {frozenset(s) for s in ((0, 1), (1, 3), (3, 4), (4, 0))})
        self.assertEqual(tr.delaunay(self.POINTS).shape, (4, 3))
        points, edges, origins, directions = tr.voronoi(self.POINTS)
        self.assertEqual((points.shape, edges.shape, origins.shape, directions.shape), ((4, 2), (4, 2), (4,), (4, 2)))
        self.assertEqual({tuple(p) for p in points}, {(0, 0.5), (0.5, 0), (1, 0.5), (0.5, 1)})
        for origin, direction in zip(origins, directions):
            self.assertGreater(np.dot(points[origin] - 0.5, direction), 0)

    def test_data(self):
        for name, switches in [("face", "p"), ("box", "pc"), ("face", "pq10"), ("face", "pq0D"), ("spiral", ""), ("spiral", "q"),
                               ("spiral", "q32.5"), ("spiral", "a.2"), ("la", "pq"), ("la", "pqa"), ("A", "p"), ("ell", "pq"),
                               ("dots", ""), ("double_hex", "pqYa0.0015"), ("double_hex2", "pqYa0.0060"), ("double_hex3", "pqa0.0015"),
                               ("square_circle_hole", "pq"), ("diamond_02_00009", "v"), ("bbox.1", "rpa"), ("bbox.1", "rpaa.5"),
                               ("box.1", "rpa0.2"), ("box.2", "rpa0.05"), ("box.3", "rpa0.0125"), ("box.4", "rp")]:
            with self.subTest(name=name, switches=switches):
                mesh = tr.triangulate(tr.get_data(name), switches)
                self.assertTrue(driftmesh.check(as_mesh(mesh), min_angle=0).accepted)
                self.assertEqual(len(tr.triangulate(tr.get_data(name), switches + "Q")["triangles"]), len(mesh["triangles"]))
        self.assertEqual(len(tr.triangulate(tr.get_data("double_hex"), "pqYa0.0015")["segments"]), 72 + 24)
        with self.assertRaisesRegex(KeyError, "spiral"):
            tr.get_data("nothing")

    def test_load(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "a.node").write_text("# points\n4 2 1 1\n1 0 0 10 5\n2 1 0 11 6\n3 1 1 12 7\n4 0 1 13 8\n")
            (folder / "a.ele").write_text("2 3 0\n1 1 2 3\n2 1 3 4\n")
            (folder / "a.poly").write_text("0 2 0 0\n4 1\n1 1 2 3\n2 2 3 3\n3 3 4 3\n4 4 1 3\n1\n1 0.5 0.25\n1\n1 0.25 0.5 7 0.1\n")
            (folder / "a.area").write_text("2\n1 -1\n2 0.5\n")
            (folder / "a.neigh").write_text("2 3\n1 -1 2 -1\n2 -1 -1 1\n")
            tables = tr.load(folder, "a")
            self.assertEqual(tables["triangles"].tolist(), [[0, 1, 2], [0, 2, 3]])
            self.assertEqual(tables["segments"].tolist(), [[0, 1], [1, 2], [2, 3], [3, 0]])
            self.assertEqual(tables["segment_markers"].tolist(), [[3]] * 4)
            self.assertEqual(tables["vertex_markers"].tolist(), [[5], [6], [7], [8]])
            self.assertEqual(tables["vertex_attributes"].tolist(), [[10], [11], [12], [13]])
            self.assertEqual((tables["holes"].tolist(), tables["regions"].tolist()), ([[0.5, 0.25]], [[0.25, 0.5, 7, 0.1]]))
            self.assertEqual(tables["triangle_max_area"].tolist(), [[-1], [0.5]])
            self.assertEqual(tables["neighbors"].tolist(), [[-1, 1, -1], [-1, -1, 0]])
            with self.assertRaises(FileNotFoundError):
                tr.load(folder, "b")
            self.assertEqual(tr.loads(poly="3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n")["segments"].tolist(),
                             [[0, 1], [1, 2], [2, 0]])

    def test_plot(self):
        class Axes:
            def __init__(self):
                self.calls = []
                self.axes = self

            def __getattr__(self, name):
                return lambda *args, **kw: self.calls.append(name) or self

        class Pyplot(Axes):
            def subplot(self, *args, **kw):
                return self

        axes = Axes()
        points, edges, origins, directions = tr.voronoi(self.POINTS)
        tr.plot(axes, vertices=points, edges=edges, ray_origins=origins, ray_directions=directions)
        self.assertEqual(axes.calls.count("plot"), 1 + len(edges) + len(origins))
        pyplot = Pyplot()
        A = tr.get_data("face")
        tr.compare(pyplot, A, tr.triangulate(A, "pq"))
        self.assertIn("triplot", pyplot.calls)


def round_trip_connect(start, end):
    return [(i, i + 1) for i in range(start, end)] + [(end, start)]


class MeshPy(unittest.TestCase):
    def test_l_shape_with_a_graded_hole(self):
        points = [(1, 0), (1, 1), (-1, 1), (-1, -1), (1, -1), (1, 0)]
        facets = round_trip_connect(0, len(points) - 1)
        first = len(points)
        points += [(3 * np.cos(a), 3 * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 30, endpoint=False)]
        facets += round_trip_connect(first, len(points) - 1)

        def needs_refinement(vertices, area):
            bary = np.sum(np.array(vertices), axis=0) / 3
            return bool(area > 0.01 + abs(np.linalg.norm(bary, np.inf) - 1) * 0.1)

        info = meshpy_triangle.MeshInfo()
        info.set_points(points)
        info.set_holes([(0, 0)])
        info.set_facets(facets)
        mesh = meshpy_triangle.build(info, refinement_func=needs_refinement)
        mesh_points, mesh_tris = np.array(mesh.points), np.array(mesh.elements)
        tables = dict(vertices=mesh_points, triangles=mesh_tris)
        self.assertAlmostEqual(areas(tables).sum(), 15 * 9 * np.sin(2 * np.pi / 30) - 4, places=9)
        self.assertFalse(any(needs_refinement(mesh_points[t], a) for t, a in zip(mesh_tris, areas(tables))))
        self.assertGreaterEqual(smallest_angle(tables), 20 - 1e-9)

    def test_markers_regions_and_attributes(self):
        info = meshpy_triangle.MeshInfo()
        info.set_points([(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)], [0, 0, 0, 0, 4, 0])
        info.set_facets([(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)], facet_markers=[1, 1, 2, 3, 3, 2, 9])
        info.regions.resize(2)
        info.regions[0] = [0.5, 0.5, 10, 0.01]
        info.regions[1] = [1.5, 0.5, 20, 0.1]
        mesh = meshpy_triangle.build(info, attributes=True, volume_constraints=True, min_angle=30, generate_faces=True)
        tables = dict(vertices=np.array(mesh.points), triangles=np.array(mesh.elements))
        region = np.array(mesh.element_attributes)
        for attribute, bound in ((10, 0.01), (20, 0.1)):
            self.assertLessEqual(areas(tables)[region == attribute].max(), bound)
        self.assertEqual(set(region), {10, 20})
        self.assertEqual(set(mesh.facet_markers), {1, 2, 3, 9})
        self.assertEqual(set(mesh.face_markers), {0, 1, 2, 3, 9})
        self.assertEqual(mesh.point_markers[4], 4)
        self.assertGreaterEqual(smallest_angle(tables), 30 - 1e-9)
        walls = [face for face, marker in zip(mesh.faces, mesh.face_markers) if marker == 9]
        self.assertTrue(all(mesh.points[a][0] == 1 and mesh.points[b][0] == 1 for a, b in walls))

    def test_options(self):
        info = meshpy_triangle.MeshInfo()
        info.set_points([(0, 0), (1, 0), (1, 1), (0, 1)])
        info.set_facets(round_trip_connect(0, 3))
        plain = meshpy_triangle.build(info, quality_meshing=False)
        self.assertEqual((len(plain.points), len(plain.elements)), (4, 2))
        self.assertEqual(len(plain.faces), 0)
        self.assertEqual(len(meshpy_triangle.build(info, max_volume=1e-2, allow_volume_steiner=False).points), 4)
        whole = meshpy_triangle.build(info, max_volume=1e-2, allow_boundary_steiner=False)
        self.assertEqual(len(whole.facets), 4)
        six = meshpy_triangle.build(info, max_volume=1e-2, mesh_order=2, generate_neighbor_lists=True)
        self.assertEqual(len(six.elements[0]), 6)
        self.assertEqual(len(six.neighbors), len(six.elements))
        with self.assertRaises(ValueError):
            meshpy_triangle.build(info, max_volume=-1)
        with self.assertRaises(ValueError):
            info.set_facets([(0, 1)], facet_markers=[1, 2])

    def test_refine(self):
        info = meshpy_triangle.MeshInfo()
        info.set_points([(0, 0), (1, 0), (1, 1), (0, 1)])
        info.set_facets(round_trip_connect(0, 3))
        mesh = meshpy_triangle.build(info, max_volume=0.05, min_angle=25)
        mesh.element_volumes.setup()
        for i in range(len(mesh.elements)):
            mesh.element_volumes[i] = -1
        for i in range(0, len(mesh.elements), 10):
            mesh.element_volumes[i] = 1e-3
        fine = meshpy_triangle.refine(mesh)
        self.assertGreater(len(fine.elements), len(mesh.elements))
        self.assertEqual(list(fine.points)[:len(mesh.points)], list(mesh.points))
        everywhere = meshpy_triangle.refine(pickle.loads(pickle.dumps(fine)), refinement_func=lambda vertices, area: area > 1e-3)
        self.assertLessEqual(areas(dict(vertices=np.array(everywhere.points), triangles=np.array(everywhere.elements))).max(), 1e-3)

    def test_arrays(self):
        info = meshpy_triangle.MeshInfo()
        info.points.resize(3)
        info.points[0] = (1, 2)
        info.points[2, 1] = 17
        self.assertEqual((list(info.points), info.points.unit, info.points[2, 1]), ([[1, 2], [0, 0], [0, 17]], 2, 17))
        self.assertFalse(info.point_markers.allocated)
        info.point_markers.setup()
        info.point_markers[1] = 5
        self.assertEqual((list(info.point_markers), len(info.copy().point_markers)), ([0, 5, 0], 3))
        info.number_of_point_attributes = 2
        info.point_attributes.setup()
        self.assertEqual(info.point_attributes[0], [0, 0])
        info.point_markers.deallocate()
        self.assertEqual(len(info.point_markers), 0)
        with self.assertRaises(IndexError):
            info.points[3]

    def test_helpers(self):
        points, facets, markers = meshpy_triangle.subdivide_facets([2, 1], [(0, 0), (2, 0), (2, 2)], [(0, 1), (1, 2)], [7, 8])
        self.assertEqual((points, facets, markers), ([(0, 0), (2, 0), (2, 2), (1, 0)], [(0, 3), (3, 1), (1, 2)], [7, 7, 8]))
        self.assertEqual(len(meshpy_triangle.subdivide_facets(3, [(0, 0), (3, 0)], [(0, 1)])[1]), 3)
        info = meshpy_triangle.MeshInfo()
        info.set_points([(0, 0), (1, 0), (0, 1)])
        info.set_facets(round_trip_connect(0, 2))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mesh.dat"
            meshpy_triangle.write_gnuplot_mesh(path, meshpy_triangle.build(info))
            self.assertEqual(len(path.read_text().split("\n")), 6)


class CyTriangle(unittest.TestCase):
    SECTION = dict(vertices=[(0, 0), (4, 0), (4, 6), (0, 6), (1, 1), (3, 1), (3, 5), (1, 5)],
                   segments=[(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)],
                   regions=[[0.5, 0.5, 0, 0.2], [2, 2, 1, 0.5]])

    def test_a_section(self):
        for switches in ("pAo2", "pq30.0Aao2"):
            mesh = cytriangle.triangulate(self.SECTION, switches)
            self.assertIsInstance(mesh["vertices"], list)
            self.assertEqual(len(mesh["triangles"][0]), 6)
            self.assertEqual({int(row[0]) for row in mesh["triangle_attributes"]}, {0, 1})
        tables = {name: np.array(mesh[name]) for name in ("vertices", "triangles")}
        tables["triangles"] = tables["triangles"][:, :3]
        for region, bound in ((0, 0.2), (1, 0.5)):
            self.assertLessEqual(areas(tables)[np.array(mesh["triangle_attributes"])[:, 0] == region].max(), bound)

    def test_objects(self):
        section = cytriangle.CyTriangle(self.SECTION)
        self.assertEqual(section.in_dict["segments"][0], [0, 1])
        out = section.triangulate("pq20")
        self.assertIs(out, section.out)
        before = out.vertices
        fine = section.refine("pqa0.1")
        self.assertEqual(fine.vertices[:len(before)], before)
        self.assertEqual(section.out_dict["triangles"], fine.triangles)
        self.assertEqual(out.to_dict(opt="np")["triangles"].shape[1], 3)
        self.assertEqual(len(cytriangle.CyTriangle(dict(vertices=Helpers.POINTS)).voronoi().edges), 4)
        self.assertEqual(len(cytriangle.delaunay(Helpers.POINTS)), 4)
        self.assertEqual(len(cytriangle.convex_hull(Helpers.POINTS)), 4)
        self.assertEqual(len(cytriangle.voronoi(Helpers.POINTS)["ray_origins"]), 4)
        with self.assertRaisesRegex(ValueError, "vertexes"):
            cytriangle.CyTriangle(dict(vertexes=[]))


if __name__ == "__main__":
    print(f"seed: DRIFTMESH_SEED={SEED}")
    unittest.main()

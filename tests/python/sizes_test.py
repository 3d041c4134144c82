"""Rules for sizes, rasters of other packages, and domains from their polygons."""

import types
import unittest

import driftmesh
import numpy as np
from driftmesh import sizes

SQUARE = driftmesh.Pslg([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]], segment_markers=[1, 2, 3, 4])


def points_of(rule):
    return len(driftmesh.mesh(SQUARE, size=rule, max_triangles=200_000).points)


def plane(x, y):
    return x + 2 * y


class Rules(unittest.TestCase):
    def test_operators(self):
        x = sizes.expression("x")
        rule = np.float64(2) * x + 1 - x / 4 + np.int64(3) - 1
        self.assertIsInstance(rule, sizes.SizeRule)
        self.assertAlmostEqual(rule(4, 0), 10)
        self.assertAlmostEqual((8 / x)(4, 0), 2)
        self.assertAlmostEqual((8 - x)(4, 0), 4)
        self.assertAlmostEqual(sizes.minimum(x, 3, 5)(4, 0), 3)
        self.assertAlmostEqual(sizes.maximum(1, x, 3)(4, 0), 4)
        self.assertAlmostEqual(sizes.expression("a + b*y", a=x, b=2)(4, 3), 10)
        self.assertIn("distance(1, 2)", repr(1 + sizes.distance(1, 2)))

    def test_meshes(self):
        rule = 0.02 + 0.1 * sizes.distance(1)
        mesh = driftmesh.mesh(SQUARE, size=rule)
        self.assertTrue(driftmesh.check(mesh, SQUARE, size=rule))
        self.assertFalse(driftmesh.check(mesh, SQUARE, size=rule / 2))
        self.assertEqual(points_of(0.05 + sizes.distance(to=[[[0, 0], [1, 0]]])), points_of(0.05 + sizes.distance(1)))
        self.assertEqual(points_of(0.05 + sizes.distance(to=SQUARE)), points_of(0.05 + sizes.distance()))
        self.assertGreater(points_of(sizes.width() / 8), points_of(sizes.width() / 3))
        jump = sizes.expression("x < 0.1 ? 0.01 : 1")
        self.assertGreater(points_of(jump.limited(gradation=0.1)), 1.5 * points_of(jump))
        self.assertLess(points_of(jump.limited(shortest=0.05)), points_of(jump) / 4)
        x = mesh.points[:, 0]
        self.assertGreater(points_of(sizes.minimum(sizes.on_mesh(mesh, 0.02 + 0.1 * x), 0.05)), points_of(sizes.on_mesh(mesh, 0.02 + 0.1 * x)))

    def test_rasters(self):
        x, y = np.arange(5) * 0.25, np.arange(7) / 6
        values = plane(*np.meshgrid(x, y))
        xarray = types.SimpleNamespace(dims=("time", "lat", "lon"), values=values[None, ::-1], coords={"lon": x, "lat": y[::-1]})
        transform = types.SimpleNamespace(a=0.25, b=0, c=-0.125, d=0, e=-1 / 6, f=1 + 1 / 12)
        rasterio = types.SimpleNamespace(transform=transform, read=lambda band, masked: np.ma.masked_array(values[::-1], values[::-1] > 99))
        for raster in (sizes.raster(values, 0, 0, 0.25, 1 / 6), sizes.raster(values[::-1, ::-1], 1, 1, -0.25, -1 / 6),
                       sizes.raster(xarray), sizes.raster(rasterio)):
            self.assertAlmostEqual(raster(0.3, 0.6), plane(0.3, 0.6), places=5)
        self.assertAlmostEqual(sizes.slope(xarray)(0.3, 0.6), np.sqrt(5), places=5)
        gaps = np.ma.masked_less(values, 0.4)
        self.assertGreaterEqual(sizes.raster(gaps, 0, 0, 0.25, 1 / 6)(0, 0), 0.4)
        self.assertGreater(points_of(0.02 + 0.05 * sizes.raster(xarray)), 200)

    def test_what_is_wrong_is_said(self):
        values = np.ones((3, 4))
        wrong = types.SimpleNamespace(dims=("y", "x"), values=values, coords={"x": [0, 1, 3, 4], "y": [0, 1, 2]})
        turned = types.SimpleNamespace(transform=types.SimpleNamespace(a=1, b=0.5, c=0, d=0, e=1, f=0), read=None)
        for call, error, says in (
                (lambda: sizes.raster(values), TypeError, "x0, y0"), (lambda: sizes.raster(values, 0, 0), TypeError, "all of"),
                (lambda: sizes.raster(values[0], 0, 0, 1, 1), ValueError, "shape"), (lambda: sizes.raster(wrong), ValueError, "evenly"),
                (lambda: sizes.raster(turned), ValueError, "rotated"), (lambda: sizes.raster(values, 0, 0, 0, 1), driftmesh.Error, "spacings"),
                (lambda: sizes.raster(values * np.nan, 0, 0, 1, 1), driftmesh.Error, "no value"),
                (lambda: sizes.distance(1, to=SQUARE), TypeError, "not both"), (lambda: sizes.distance(to=[[0, 1]]), ValueError, "shape"),
                (lambda: sizes.width() + "1", TypeError, "length"), (lambda: sizes.width() + True, TypeError, "length"),
                (lambda: points_of(sizes.expression("sqr(x)")), driftmesh.InputError, "sqr"),
                (lambda: points_of(sizes.distance(9)), driftmesh.InputError, "9"),
                (lambda: sizes.width()(0, 0), driftmesh.InputError, "width")):
            with self.assertRaisesRegex(error, says):
                call()


class Polygons(unittest.TestCase):
    ring = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]
    hole = [(1, 1), (1, 2), (2, 2), (1, 1)]

    def area(self, shapes):
        mesh = driftmesh.mesh(driftmesh.from_polygons(shapes), max_area=0.1)
        a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
        (ux, uy), (vx, vy) = (b - a).T, (c - a).T
        return (ux * vy - uy * vx).sum() / 2

    def test_geometries(self):
        polygon = {"type": "Polygon", "coordinates": [self.ring, self.hole]}
        shifted = [[(x + 10, y) for x, y in self.ring]]
        domain = driftmesh.from_polygons(types.SimpleNamespace(__geo_interface__=polygon))
        self.assertEqual(sorted(domain.segment_markers.tolist()), [1] * 4 + [2] * 3)
        self.assertAlmostEqual(self.area(polygon), 15.5)
        self.assertAlmostEqual(self.area({"type": "MultiPolygon", "coordinates": [polygon["coordinates"], shifted]}), 31.5)
        features = [{"type": "Feature", "geometry": g, "properties": {}} for g in (polygon, None, {"type": "Polygon", "coordinates": shifted})]
        frame = types.SimpleNamespace(__geo_interface__={"type": "FeatureCollection", "features": features}, crs=None)
        self.assertAlmostEqual(self.area(frame), 31.5)
        self.assertAlmostEqual(self.area([polygon, {"type": "Polygon", "coordinates": shifted}]), 31.5)
        line = {"type": "LineString", "coordinates": [(2.5, 0.5, 7.0), (3.5, 3.5, 7.0)]}
        domain = driftmesh.from_polygons([{"type": "GeometryCollection", "geometries": [polygon, line]}])
        self.assertEqual(np.count_nonzero(domain.segment_markers == 0), 1)

    def test_what_is_wrong_is_said(self):
        degrees = types.SimpleNamespace(__geo_interface__={"type": "Polygon", "coordinates": [self.ring]},
                                        crs=types.SimpleNamespace(is_geographic=True))
        for shapes, error, says in ((degrees, ValueError, "degrees"), ({"type": "Point", "coordinates": (0, 0)}, ValueError, "Point"),
                                    (3, TypeError, "int"), ("a", TypeError, "str"), ([], ValueError, "no polygons")):
            with self.assertRaisesRegex(error, says):
                driftmesh.from_polygons(shapes)


if __name__ == "__main__":
    unittest.main()

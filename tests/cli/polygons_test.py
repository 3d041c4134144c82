#!/usr/bin/env python3
"""Domains of polygons that touch, overlap, cross or repeat themselves: in one piece, in parts and on ranks.

usage: polygons_test.py DRIFTMESH [unittest options]
"""

import json
import re

from program import Cli, main

SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]
TOUCHING = """8 2 0 0
0 0 0
1 10 0
2 10 10
3 0 10
4 0 0
5 4 3
6 6 6
7 3 4
8 1
0 0 1 1
1 1 2 1
2 2 3 1
3 3 0 1
4 0 5 2
5 5 6 2
6 6 7 2
7 7 0 2
0
"""


def box(x, y, width, height):
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height], [x, y]]


def polygons(*features, crs="EPSG:32619"):
    """GeoJSON of features, each a list of rings."""
    return json.dumps({
        "type": "FeatureCollection",
        **({"crs": {"type": "name", "properties": {"name": crs}}} if crs else {}),
        "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": rings}}
                     for rings in features]})


# Of each domain the text, the area, and what its warning says; None: it is as it should be.
CASES = {
    "hole-crosses": (polygons([SQUARE, box(5, 4, 9, 2)]), 90, "a hole of feature 1 reaches outside its first ring"),
    "holes-overlap": (polygons([SQUARE, box(2, 4, 4, 4), box(5, 3, 3, 4)]), 75, "holes of feature 1 overlap at (5."),
    "polygon-over-hole": (polygons([box(4, 4, 7, 6), box(5, 7, 5, 2)], [box(4, 5, 4, 7)]), 46, None),
    "pocket": (polygons([[[0, 0], [10, 0], [10, 10], [5, 10], [7, 5], [3, 5], [5, 10], [0, 10], [0, 0]]]), 90, None),
    "doubled-clip-edge": (polygons([[[0, 0], [10, 0], [10, 10], [0, 10], [0, 7], [5, 7], [5, 3], [0, 3], [0, 7], [0, 3],
                                     [0, 0]]]), 80, "the first ring of feature 1 runs more than once along one edge"),
    "keyhole": (polygons([[[0, 0], [10, 0], [10, 10], [0, 10], [0, 0], [4, 4], [4, 6], [6, 6], [6, 4], [4, 4], [0, 0]]]), 96,
                "at (2, 2)"),
    "two-holes": (polygons([box(0, 0, 20, 25), [[2, 12], [4, 23], [5, 23], [2, 12]],
                            [[2, 12], [6, 23], [7, 23], [2, 12]]]), 489, None),
    "degenerate-rings": (polygons([SQUARE, [[2, 2], [2, 2], [2, 2]], [[4, 4], [6, 6], [4, 4]]], [[[1, 1], [9, 9], [1, 1]]]), 100,
                         "feature 1 has a ring of fewer than three different corners, which covers nothing"),
}


class Polygons(Cli):
    def area(self, summary):
        return float(re.search(r"([0-9.e+]+) in total", summary).group(1))

    def test_areas(self):
        for name, (text, area, _) in CASES.items():
            file = self.write(name + ".geojson", text)
            bounds = ("--area", area / 500)
            runs = [lambda *more: self.succeed("mesh", file, *bounds, "-o", "x.vtu", *more)]
            for parts in [], ["-n", 16], ["-n", 60]:
                with self.subTest(name=name, parts=parts):
                    self.assertAlmostEqual(self.area(runs[0](*parts)), area, delta=1e-3 * area)
                    self.succeed("check", "x.vtu", file, *bounds)
            for ranks in 2, 5:
                with self.subTest(name=name, ranks=ranks):
                    done = self.on_ranks(ranks, "mesh", file, *bounds, "-n", 16, "-o", "x.pvtu")
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertAlmostEqual(self.area(done.stdout), area, delta=1e-3 * area)
                    self.succeed("check", "x.pvtu", file, *bounds)

    def test_what_has_a_meaning_is_warned_of_and_refused_by_strict(self):
        for name, (text, _, warning) in CASES.items():
            with self.subTest(name=name):
                file = self.write(name + ".geojson", text)
                result = self.run_program("mesh", file, "-o", "x.vtu")
                self.assertEqual(result.returncode, 0, result.stderr)
                if warning is None:
                    self.assertNotIn("warning", result.stdout + result.stderr)
                    self.succeed("mesh", file, "--strict", "-o", "x.vtu")
                else:
                    self.assertIn(warning, result.stderr)
                    self.refuse("mesh", file, "--strict", "-o", "x.vtu", says=[warning])

    def test_rings_that_touch_are_nested(self):
        file = self.write("touching.poly", TOUCHING)
        for parts in [], ["-n", 16]:
            summary = self.succeed("mesh", file, "--holes", "nested", "--area", "0.2", "-o", "x.vtu", *parts)
            self.assertAlmostEqual(self.area(summary), 94, delta=0.1)
            self.succeed("check", "x.vtu", file, "--holes", "nested", "--area", "0.2")

    def test_vertices_on_edges_in_degrees_stay_there(self):
        parts = [[box(-71, 40, 2, 1)], [box(-71, 41, 1, 1)], [box(-70, 41, 1, 1)]]
        self.write("parts.geojson", polygons(*parts, crs=None))
        whole = [[-71, 40], [-69, 40], [-69, 41], [-69, 42], [-70, 42], [-71, 42], [-71, 41], [-71, 40]]
        self.write("whole.geojson", polygons([whole], crs=None))
        self.assertAlmostEqual(self.area(self.succeed("mesh", "parts.geojson", "-o", "parts.vtu")),
                               self.area(self.succeed("mesh", "whole.geojson", "-o", "whole.vtu")), delta=1)

    def test_a_poly_of_polygons_means_the_same(self):
        for name, (text, area, _) in CASES.items():
            with self.subTest(name=name):
                self.write("x.geojson", text)
                self.succeed("mesh", "x.geojson", "-o", "x.poly")
                self.assertAlmostEqual(self.area(self.succeed("mesh", "x.poly", "-o", "again.vtu")), area,
                                       delta=1e-3 * area)

    def test_a_decomposition_belongs_to_its_polygons(self):
        self.write("a.geojson", CASES["hole-crosses"][0])
        self.write("b.geojson", polygons([SQUARE], [box(5, 4, 9, 2)]))
        self.succeed("decompose", "a.geojson", "-n", 4, "-o", "a.dec")
        self.succeed("mesh", "a.geojson", "--decomposition", "a.dec", "-o", "x.vtu")
        self.refuse("mesh", "b.geojson", "--decomposition", "a.dec", "-o", "x.vtu", says=["another input"])


if __name__ == "__main__":
    main()

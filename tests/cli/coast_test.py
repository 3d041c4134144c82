#!/usr/bin/env python3
"""Grids as SCHISM and ADCIRC take them, and coasts wherever they lie on the globe.

usage: coast_test.py DRIFTMESH [unittest options]
"""

import collections
import json
import math
import os
import random
import re

from program import Cli, main

# A square with two islands, of markers 3, 2 and 4.
OPEN_RING = """12 2 0 0
0 0 0
1 100 0
2 100 100
3 0 100
4 40 40
5 60 40
6 60 60
7 40 60
8 10 10
9 20 10
10 20 20
11 10 20
12 1
0 0 1 3
1 1 2 3
2 2 3 3
3 3 0 3
4 4 5 2
5 5 6 2
6 6 7 2
7 7 4 2
8 8 9 4
9 9 10 4
10 10 11 4
11 11 8 4
2
0 50 50
1 15 15
"""

# An island that touches the shore.
PINCHED = """7 2 0 0
0 0 0
1 100 0
2 100 100
3 0 100
4 0 50
5 30 40
6 30 60
8 1
0 0 1 1
1 1 2 1
2 2 3 1
3 3 4 1
4 4 0 1
5 4 5 2
6 5 6 2
7 6 4 2
1
0 20 50
"""


class Grid:
    """A grid read as its format is described, by lines and words alone."""

    def __init__(self, path):
        rows = iter(path.read_text().splitlines())
        next(rows)
        elements, nodes = (int(word) for word in next(rows).split()[:2])
        self.points = [tuple(float(word) for word in next(rows).split()[1:3]) for _ in range(nodes)]
        self.triangles = [tuple(int(word) - 1 for word in next(rows).split()[2:5]) for _ in range(elements)]
        self.strings = []  # (type, nodes); the type of open ones is None
        self.counts_agree = True
        for kind in ("open", "land"):
            strings, total = (int(next(rows).split()[0]) for _ in range(2))
            for _ in range(strings):
                words = next(rows).split()
                string = [int(next(rows).split()[0]) - 1 for _ in range(int(words[0]))]
                total -= len(string)
                self.strings.append((None if kind == "open" else int(words[1]), string))
            self.counts_agree &= total == 0
        self.is_read = next(rows, None) is None

    def border(self):
        edges = {edge for a, b, c in self.triangles for edge in ((a, b), (b, c), (c, a))}
        return {(a, b) for a, b in edges if (b, a) not in edges}

    def faults(self):
        """What SCHISM or ADCIRC would refuse of the strings."""
        found = [] if self.counts_agree and self.is_read else ["counts"]
        listed, ends = collections.Counter(), collections.Counter()
        for kind, nodes in self.strings:
            if len(set(nodes)) < len(nodes):
                found.append(f"a node twice in a string of type {kind}")
            chain = nodes + nodes[:1] if kind in (1, 11, 21) else nodes
            listed.update(zip(chain, chain[1:]))
            ends[chain[0]] += 1
            ends[chain[-1]] -= 1
            if kind == 1 and self.area(nodes) > 0:
                found.append("an island that runs counterclockwise")
        if set(listed) != self.border() or max(listed.values()) > 1:
            found.append("strings are not the border")
        if any(ends.values()):
            found.append("strings that do not join")
        return found

    def area(self, nodes):
        places = [self.points[node] for node in nodes]
        return sum(x * v - u * y for (x, y), (u, v) in zip(places, places[1:] + places[:1])) / 2

    def length(self, kind):
        return sum(math.dist(self.points[a], self.points[b]) for found, nodes in self.strings if found == kind
                   for a, b in zip(nodes, nodes[1:] + (nodes[:1] if kind == 1 else [])))


class Grids(Cli):
    def mesh(self, domain, *options):
        """The grid, and what the program said."""
        self.write("in.poly", domain)
        result = self.run_program("mesh", "in.poly", "--area", "100", *options, "-o", "hgrid.gr3")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        grid = Grid(self.folder / "hgrid.gr3")
        self.assertEqual(grid.faults(), [])
        return grid, result.stdout + result.stderr

    def test_rings_that_are_open_all_around_are_two_chains_each(self):
        for parts in ([], ["-n", "5"]):
            grid, _ = self.mesh(OPEN_RING, "--open-boundary", "3", *parts)
            self.assertEqual([kind for kind, _ in grid.strings], [None, None, 1, 1])
            self.assertAlmostEqual(grid.length(None), 400)
            grid, _ = self.mesh(OPEN_RING, "--open-boundary", "4,2", *parts)
            self.assertEqual([kind for kind, _ in grid.strings], [None, None, None, None, 0, 0])
            self.assertAlmostEqual(grid.length(None), 120)
            grid, _ = self.mesh(OPEN_RING, *parts)
            self.assertEqual([kind for kind, _ in grid.strings], [0, 0, 1, 1])

    def test_an_island_that_touches_the_shore_is_a_ring_of_its_own_and_is_named(self):
        for parts in ([], ["-n", "3"]):
            grid, said = self.mesh(PINCHED, *parts)
            self.assertEqual([kind for kind, _ in grid.strings], [0, 0, 1])
            self.assertAlmostEqual(grid.length(1), 20 + 2 * math.hypot(30, 10))
            self.assertIn("boundaries touch in node ", said)
            self.assertIn(" (0, 50)", said)
            grid, _ = self.mesh(PINCHED, "--open-boundary", "2", *parts)
            self.assertEqual([kind for kind, _ in grid.strings], [None, None, 0, 0])
        self.succeed("mesh", "in.poly", "-o", "m.vtu")
        result = self.run_program("convert", "m.vtu", "fort.14")
        self.assertIn("warning: fort.14: boundaries touch in node ", result.stderr)

    def test_random_markers_on_the_rings_of_a_domain(self):
        seed = os.environ.get("DRIFTMESH_SEED", "1")
        generator = random.Random(seed)
        for _ in range(12):
            sides = 24
            ring = [(50 + 45 * math.cos(2 * math.pi * i / sides), 50 + 45 * math.sin(2 * math.pi * i / sides))
                    for i in range(sides)]
            points, segments, holes = list(ring), [], []
            kinds = generator.choice([[3], [1, 3], [1, 2, 3, 4]])
            segments += [(i, (i + 1) % sides, generator.choice(kinds)) for i in range(sides)]
            for x in (30, 50, 70):  # islands, of which neighbors may touch
                first, wide = len(points), generator.choice([6, 10])
                own = [(x - wide, 50), (x, 50 - wide), (x + wide, 50), (x, 50 + wide)]
                points += own
                segments += [(first + i, first + (i + 1) % 4, generator.choice(kinds)) for i in range(4)]
                holes.append((x, 50))
            text = f"{len(points)} 2 0 0\n" + "".join(f"{i} {x!r} {y!r}\n" for i, (x, y) in enumerate(points))
            text += f"{len(segments)} 1\n" + "".join(f"{i} {a} {b} {m}\n" for i, (a, b, m) in enumerate(segments))
            text += f"{len(holes)}\n" + "".join(f"{i} {x} {y}\n" for i, (x, y) in enumerate(holes))
            with self.subTest(seed=seed, text=text):
                grid, _ = self.mesh(text, "--open-boundary", "3")
                wanted = sum(math.dist(points[a], points[b]) for a, b, marker in segments if marker == 3)
                self.assertAlmostEqual(grid.length(None), wanted, 6)

    def test_conversions_keep_the_types_of_boundaries(self):
        self.write("in.poly", OPEN_RING)
        self.succeed("mesh", "in.poly", "--area", "100", "--marker-name", "3=ibtype 52", "--marker-name", "4=ibtype 21",
                     "--marker-name", "2=open", "-o", "fort.14", "-o", "m.vtu")
        grid = Grid(self.folder / "fort.14")
        self.assertEqual(grid.faults(), [])
        self.assertEqual(sorted(str(kind) for kind, _ in grid.strings), ["21", "52", "52", "None", "None"])
        for other in ("a.grd", "a.gr3", "a.msh"):
            result = self.run_program("convert", "fort.14", other)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        for source in ("a.grd", "a.gr3", "m.vtu", "a.msh"):
            self.succeed("convert", source, "again.14")
            self.assertEqual(Grid(self.folder / "again.14").strings, grid.strings)
        result = self.run_program("convert", "fort.14", "m.ele")
        self.assertIn("open (2 strings), ibtype 21 (1 string), ibtype 52 (2 strings)", result.stderr)


class Coasts(Cli):
    RING = [[-70, 41], [-69.9, 41], [-69.9, 41.1], [-70, 41.1], [-70, 41]]

    def area_of(self, geometry, *options):
        """The area of the mesh, and all that was said."""
        self.write("in.geojson", json.dumps(geometry))
        result = self.run_program("mesh", "in.geojson", *options, "-o", "m.vtu")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return float(re.search(r"([0-9.]+(?:e[+-]?[0-9]+)?) in total", result.stdout).group(1)), result.stdout + result.stderr

    def test_degrees_on_any_datum_become_meters(self):
        plain, _ = self.area_of({"type": "Polygon", "coordinates": [self.RING]})
        self.assertGreater(plain, 9e7)
        for name in ("urn:ogc:def:crs:EPSG::4269", "EPSG:4283"):
            area, said = self.area_of({"type": "Polygon", "coordinates": [self.RING],
                                       "crs": {"type": "name", "properties": {"name": name}}})
            self.assertEqual(area, plain)
            self.assertNotIn("warning", said)

    def test_what_looks_like_degrees_in_an_unknown_system_is_told(self):
        geometry = {"type": "Polygon", "coordinates": [self.RING],
                    "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2154"}}}
        area, said = self.area_of(geometry)
        self.assertAlmostEqual(area, 0.01)
        self.assertIn("warning: coordinates in the system 'urn:ogc:def:crs:EPSG::2154'", said)
        self.refuse("mesh", "in.geojson", "--strict", "-o", "m.vtu", says=["look like degrees"])

    def test_domains_across_the_180th_meridian(self):
        def box(west, east):
            return [[[west, -19], [east, -19], [east, -16], [west, -16], [west, -19]]]

        there, _ = self.area_of({"type": "Polygon", "coordinates": box(-2.5, 1.5)})
        wanted = there  # the same around Greenwich, in the middle of which a point is missing
        cut, said = self.area_of({"type": "MultiPolygon", "coordinates": [box(177.5, 180), box(-180, -178.5)]})
        self.assertLess(abs(cut / wanted - 1), 1e-3)
        self.assertIn("UTM zone 60S", said)
        self.assertIn("6 points", said)
        for ring in (box(177.5, 181.5), box(177.5, -178.5), box(-182.5, -178.5)):
            area, said = self.area_of({"type": "Polygon", "coordinates": ring})
            self.assertLess(abs(area / wanted - 1), 1e-9)
            self.assertIn("UTM zone 60S", said)
        self.succeed("mesh", "in.geojson", "--area", "1000M", "-n", "4", "-o", "p.vtu")
        self.assertIn("accepted", self.succeed("check", "p.vtu", "in.geojson"))

    def test_rasters_in_degrees_serve_domains_across_the_180th_meridian(self):
        def raster(west):
            row = " ".join(str(west + column + 0.5) for column in range(360))
            return f"ncols 360\nnrows 60\nxllcorner {west}\nyllcorner -60\ncellsize 1\n" + (row + "\n") * 60

        self.write("greenwich.asc", raster(0))
        self.write("dateline.asc", raster(-180))
        ring = [[177.5, -19], [-178.5, -19], [-178.5, -16], [177.5, -16], [177.5, -19]]
        self.write("in.geojson", json.dumps({"type": "Polygon", "coordinates": [ring]}))
        options = ["--area", "1000M", "--depth", "depth", "-o", "fort.14"]
        self.succeed("mesh", "in.geojson", "--raster", "depth=greenwich.asc", *options)
        lines = (self.folder / "fort.14").read_text().splitlines()
        depths = [float(line.split()[3]) for line in lines[2:2 + int(lines[1].split()[1])]]
        self.assertAlmostEqual(min(depths), 177.5, delta=0.1)
        self.assertAlmostEqual(max(depths), 181.5, delta=0.1)
        self.refuse("mesh", "in.geojson", "--raster", "depth=dateline.asc", *options,
                    says=["dateline.asc", "ends within the domain"])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Domains in degrees, and what files of their meshes have: longitudes and latitudes, projections, names, open boundaries.

usage: degrees_test.py DRIFTMESH [unittest options]
"""

import json
import math
import pathlib
import random
import re
import shutil

from program import Cli, main

BAY = pathlib.Path(__file__).resolve().parents[2] / "examples" / "coast" / "bay.geojson"


def feature(kind, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


def collection(*features):
    return json.dumps({"type": "FeatureCollection", "features": list(features)})


def points_of(grid):
    """The points and triangles of a .14 or .gr3."""
    lines = grid.splitlines()
    triangles, points = map(int, lines[1].split()[:2])
    nodes = [tuple(map(float, line.split()[1:3])) for line in lines[2:2 + points]]
    return nodes, [tuple(int(v) - 1 for v in line.split()[2:5]) for line in lines[2 + points:2 + points + triangles]]


def open_boundaries(grid):
    return [int(line.split()[0]) for line in grid.splitlines() if line.endswith("nodes on this open boundary")]


def on_sphere(place):
    """The point of the sphere onto which the ellipsoid WGS 84 is mapped with all its angles."""
    e = math.sqrt(0.0066943799901413165)
    lon, lat = map(math.radians, place)
    isometric = math.asinh(math.tan(lat)) - e * math.atanh(e * math.sin(lat)) if abs(place[1]) < 90 else math.copysign(50, lat)
    cosine = 1 / math.cosh(isometric)
    return (cosine * math.cos(lon), cosine * math.sin(lon), math.tanh(isometric))


def angles_on_sphere(triangle):
    """Between great circles, at each corner, in degrees; negative for a triangle that is clockwise."""
    def cross(u, v):
        return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])

    def dot(u, v):
        return sum(x * y for x, y in zip(u, v))

    corners = [on_sphere(place) for place in triangle]
    angles = []
    for i in range(3):
        p, q, r = (corners[(i + k) % 3] for k in range(3))
        first, second = cross(p, q), cross(p, r)  # normals of the planes of both sides
        angles.append(math.degrees(math.atan2(dot(cross(first, second), p), dot(first, second))))
    return angles


class Traps(Cli):
    def creeks(self, seed):
        """A bay whose frame in the east cuts creeks, each with a width of its own; widths in meters, ascending."""
        chance = random.Random(seed)
        widths = sorted(chance.sample(range(60, 900, 40), chance.randint(1, 4)))
        ring, lines, y = [[0.0, 0.0], [20000.0, 0.0]], [], 3000.0
        for width in widths:
            ring += [[20000.0, y], [22000.0, y], [22000.0, y + width], [20000.0, y + width]]
            lines.append([[22000.0, y], [22000.0, y + width]])
            y += width + 2000
        ring += [[20000.0, y + 1000], [0.0, y + 1000], [0.0, 0.0]]
        self.write("bay.geojson", json.dumps({
            "type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:32618"}},
            "features": [feature("Polygon", [ring]),
                         feature("MultiLineString", lines + [[[0, 0], [20000, 0]]], boundary="open")]}))
        return widths

    def test_creeks_that_the_frame_cuts_are_told_and_become_land(self):
        for seed in range(4):
            widths = self.creeks(seed)
            with self.subTest(seed=seed, widths=widths):
                told = self.run_program("mesh", "bay.geojson", "--area", "1M", "--open-boundary", "3", "-o", "all.14")
                self.assertEqual(len(open_boundaries((self.folder / "all.14").read_text())), len(widths) + 1)
                short = sum(nodes == 2 for nodes in open_boundaries((self.folder / "all.14").read_text()))
                self.assertEqual("two nodes alone" in told.stderr, short > 0, told.stderr)
                self.assertGreater(short, 0)
                from_ = widths[len(widths) // 2] + 1
                kept = 1 + sum(width >= from_ for width in widths)
                self.succeed("mesh", "bay.geojson", "--area", "1M", "--open-boundary", "3", "--open-from", from_, "-o", "some.14")
                grid = (self.folder / "some.14").read_text()
                self.assertEqual(len(open_boundaries(grid)), kept)
                self.succeed("convert", "all.14", "again.gr3", "--open-from", from_)
                self.assertEqual(len(open_boundaries((self.folder / "again.gr3").read_text())), kept)
                # Every boundary edge is in a string still.
                nodes = [int(line.split()[0]) for line in grid.splitlines() if "nodes on this" in line]
                ring = [int(line.split()[0]) for line in (self.folder / "all.14").read_text().splitlines() if "nodes on this" in line]
                self.assertEqual(sum(nodes) - len(nodes), sum(ring) - len(ring))

    def test_depths_are_called_as_their_raster_is(self):
        self.creeks(1)
        self.write("depth.asc", "ncols 5\nnrows 5\nxllcenter -4000\nyllcenter -4000\ncellsize 8000\n" +
                   "\n".join(" ".join(str(10 + i + 3 * j) for i in range(5)) for j in range(5)) + "\n")
        common = ["mesh", "bay.geojson", "--raster", "depth=depth.asc", "--depth", "depth", "--area", "4M"]
        self.succeed(*common, "-o", "m.vtu", "-o", "m.h5", "-o", "m.msh", "-o", "m.14")
        self.succeed(*common, "-n", "3", "-o", "p.pvtu")
        header = (self.folder / "m.vtu").read_bytes().split(b"<AppendedData")[0].decode()
        self.assertIn('Name="depth" format="appended"', header)
        self.assertNotIn('Name="attribute"', header)
        self.assertIn('Name="depth"', (self.folder / "p.pvtu").read_text())
        self.assertIn(b'"attribute 1: depth"', (self.folder / "m.msh").read_bytes())
        expected = (self.folder / "m.14").read_text()
        for file in ("m.vtu", "m.h5", "m.msh"):
            self.succeed("convert", file, "again.14", "--open-boundary", "3")
            self.succeed("convert", file, "again.vtu")
            self.assertIn(b'Name="depth"', (self.folder / "again.vtu").read_bytes())
        self.succeed("convert", "m.vtu", "again.14")
        self.assertEqual((self.folder / "again.14").read_text().split("= number of open")[0].rsplit("\n", 1)[0],
                         expected.split("= number of open")[0].rsplit("\n", 1)[0])
        self.succeed("check", "p.pvtu", "bay.geojson", "--area", "4M")
        # A name that files have for something else stays theirs.
        self.succeed("mesh", "bay.geojson", "--raster", "marker=depth.asc", "--depth", "marker", "--area", "4M", "-o", "n.vtu")
        self.assertIn(b'Name="attribute"', (self.folder / "n.vtu").read_bytes())
        self.succeed("check", "n.vtu", "bay.geojson")


class Degrees(Cli):
    def setUp(self):
        super().setUp()
        shutil.copy(BAY, self.folder)

    def test_grids_of_a_domain_in_degrees_are_in_degrees_and_come_back(self):
        self.succeed("mesh", "bay.geojson", "--area", "1M", "--open-boundary", "3", "-o", "m.vtu", "-o", "fort.14", "-o", "hgrid.gr3")
        for file in ("fort.14", "hgrid.gr3"):
            grid = (self.folder / file).read_text()
            self.assertEqual(grid.splitlines()[0], "driftmesh lonlat from UTM zone 18N")
            nodes, _ = points_of(grid)
            self.assertTrue(all(-77 < x < -75 and 36 < y < 38 for x, y in nodes))
            self.assertIn("accepted", self.succeed("check", file, "bay.geojson", "--area", "1M"))
            self.succeed("plot", file, "-o", "m.png")
        self.assertIn(b'Name="UTM zone 18N from lonlat"', (self.folder / "m.vtu").read_bytes())
        # Converting keeps to that, and meters are there for the asking.
        self.succeed("convert", "m.vtu", "same.14", "--open-boundary", "3")
        self.assertEqual(points_of((self.folder / "same.14").read_text())[0], points_of((self.folder / "fort.14").read_text())[0])
        self.succeed("convert", "m.vtu", "meters.14", "--crs", "projected")
        self.succeed("convert", "fort.14", "back.14", "--crs", "projected")
        there, back = (points_of((self.folder / name).read_text())[0] for name in ("meters.14", "back.14"))
        size = max(x for x, _ in there) - min(x for x, _ in there)
        worst = max(max(abs(a - b) for a, b in zip(p, q)) for p, q in zip(there, back))
        self.assertLess(worst, 1e-9 * size)
        self.assertEqual((self.folder / "meters.14").read_text().splitlines()[0], "driftmesh UTM zone 18N from lonlat")

    def test_all_formats_can_have_degrees_and_say_so(self):
        common = ["mesh", "bay.geojson", "--area", "1M", "--crs", "lonlat"]
        grids = [*common, "--open-boundary", "3"]
        outputs = ["m.vtu", "m.h5", "m.msh", "m.su2", "m.14"]
        self.succeed(*grids, *(word for output in outputs for word in ("-o", output)))
        self.succeed(*common, "-n", "4", "-o", "p.pvtu", "-o", "p.vtu")
        self.assertEqual(self.on_ranks(2, *grids, "-n", "6", "-o", "r.pvtu", "-o", "r.h5", "-o", "r.14").returncode, 0)
        self.assertTrue((self.folder / "r.14").read_text().startswith("driftmesh lonlat from UTM zone 18N\n"))
        for file in [*outputs, "p.pvtu", "p.vtu", "r.pvtu", "r.h5"]:
            with self.subTest(file=file):
                self.assertIn("accepted", self.succeed("check", file, "bay.geojson", "--area", "1M"))
        self.refuse("mesh", "bay.geojson", "--area", "1M", "--crs", "degrees", "-o", "x.14", code=2, says=["--crs", "lonlat"])
        self.write("plane.poly", "3 2 0 0\n1 0 0\n2 1000 0\n3 0 1000\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n")
        self.refuse("mesh", "plane.poly", "--crs", "lonlat", "-o", "x.14", says=["where on the globe"])

    def test_a_mesh_that_knows_where_it_is_is_a_domain_there(self):
        self.succeed("mesh", "bay.geojson", "--area", "4M", "-o", "fort.14")
        said = self.succeed("mesh", "fort.14", "--area", "2M", "-o", "anew.14")
        self.assertIn("in meters, UTM zone 18N", said)
        self.assertTrue((self.folder / "anew.14").read_text().startswith("driftmesh lonlat from"))

    def test_a_grid_in_degrees_of_another_program_gets_a_clear_answer(self):
        self.succeed("mesh", "bay.geojson", "--area", "4M", "-o", "fort.14")
        text = (self.folder / "fort.14").read_text()
        self.write("other.14", text.replace("driftmesh lonlat from UTM zone 18N", "a grid"))
        told = self.run_program("mesh", "other.14", "-o", "x.vtu")
        self.assertIn("look like longitudes and latitudes", told.stderr)
        self.assertIn("in meters, UTM zone 18N", self.succeed("mesh", "other.14", "--degrees", "--area", "2M", "-o", "y.14"))
        self.assertIn("accepted", self.succeed("check", "y.14", "other.14", "--degrees", "--area", "2M"))

    def test_a_projection_can_be_given(self):
        said = self.succeed("mesh", "bay.geojson", "--area", "1M", "--projection", "stereographic at -76 37", "--open-boundary", "3", "-o", "m.14",
                            "-o", "m.vtu")
        self.assertIn("in meters, stereographic at -76 37", said)
        for file in ("m.14", "m.vtu"):
            self.assertIn("accepted", self.succeed("check", file, "bay.geojson", "--area", "1M"))
        self.refuse("mesh", "bay.geojson", "--projection", "mercator", code=2, says=["--projection", "UTM zone"])
        self.refuse("mesh", "bay.geojson", "--projection", "UTM zone 50N", says=["40 degrees", "--projection"])


class Globe(Cli):
    open = ()

    def mesh(self, *options):
        said = self.succeed("mesh", "in.geojson", *options, *self.open, "-o", "m.14", "-o", "m.vtu", "--json", "m.json")
        self.assertIn("accepted", self.succeed("check", "m.vtu", "in.geojson", *(options if options[0] == "--area" else ())))
        self.assertIn("accepted", self.succeed("check", "m.14"))
        return said, json.loads((self.folder / "m.json").read_text())

    def assert_angles(self, least):
        nodes, triangles = points_of((self.folder / "m.14").read_text())
        angles = [angle for t in triangles for angle in angles_on_sphere([nodes[v] for v in t])]
        self.assertGreater(len(angles), 100)
        self.assertGreater(min(angles), least)

    def test_a_cap_from_180_west_to_180_east(self):
        self.open = ("--open-boundary", "3")
        for sign, name in ((1, "stereographic at 0 90"), (-1, "stereographic at 0 -90")):
            with self.subTest(sign=sign):
                cap = [[-180, sign * 66], [180, sign * 66], [180, sign * 90], [-180, sign * 90], [-180, sign * 66]]
                self.write("in.geojson", collection(feature("Polygon", [cap]),
                                                    feature("LineString", [[180, sign * 66], [-180, sign * 66]], boundary="open")))
                said, run = self.mesh("--area", "2e10")
                self.assertIn(name, said)
                # The area of the cap on a sphere of the same surface, times the scale of the projection.
                area = 2 * math.pi * 6371007.2 ** 2 * (1 - math.sin(math.radians(66)))
                self.assertTrue(1 < run["mesh"]["total_area"] / area < 1.12)
                self.assertEqual(len([line for line in (self.folder / "m.14").read_text().splitlines()
                                      if "on this open boundary" in line]), 2)
                self.assert_angles(19)

    def test_a_coast_around_a_pole_that_is_cut_along_the_180th_meridian(self):
        """As GIS have Antarctica: from the coast at 180 to the pole, and back to -180."""
        chance = random.Random(5)
        coast = [[lon, -72 + chance.uniform(-4, 4)] for lon in range(-180, 180, 6)]
        coast.append([180, coast[0][1]])
        sea = [[-180, -60], [180, -60], [180, coast[0][1]], *reversed(coast[:-1]), [-180, -60]]
        self.write("in.geojson", collection(feature("Polygon", [sea])))
        said, _ = self.mesh("--area", "2e10")
        self.assertIn("stereographic at 0 -90", said)
        # Two shores, and nothing along the meridian between them.
        grid = (self.folder / "m.14").read_text()
        self.assertEqual(grid.count("of this island"), 1)
        self.assert_angles(19)
        land = [*coast, [180, -90], [-180, -90], coast[0]]
        self.write("in.geojson", collection(feature("Polygon", [land])))
        self.mesh("--area", "2e10")
        self.assert_angles(19)

    def test_random_domains_near_poles_and_the_date_line(self):
        for seed in range(8):
            chance = random.Random(seed)
            center = (chance.uniform(-180, 180), chance.choice([-1, 1]) * chance.uniform(60, 88))
            radius = chance.uniform(1, 6)
            ring = []
            for k in range(chance.randint(9, 30)):
                turn = 2 * math.pi * k / 30
                bearing, way = turn, math.radians(radius * chance.uniform(0.6, 1))
                sine = (math.sin(math.radians(center[1])) * math.cos(way) +
                        math.cos(math.radians(center[1])) * math.sin(way) * math.cos(bearing))
                lon = math.radians(center[0]) + math.atan2(
                    math.sin(bearing) * math.sin(way) * math.cos(math.radians(center[1])),
                    math.cos(way) - math.sin(math.radians(center[1])) * sine)
                ring.append([math.remainder(math.degrees(lon), 360), math.degrees(math.asin(sine))])
            if len(ring) < 25:
                ring.append([math.remainder(center[0], 360), center[1]])
            ring.append(ring[0])
            self.write("in.geojson", collection(feature("Polygon", [ring])))
            with self.subTest(seed=seed, center=center):
                self.mesh("--triangles", "600")
                self.assert_angles(19)

    def test_all_around_the_globe_gets_a_clear_answer(self):
        self.write("in.geojson", collection(feature("Polygon", [[[-180, -60], [180, -60], [180, 60], [-180, 60], [-180, -60]]])))
        self.refuse("mesh", "in.geojson", "--area", "1e12", says=["all around the globe", "60 degrees", "part of it"])
        self.write("in.geojson", collection(feature("Polygon", [[[-70, -20], [70, -20], [70, 20], [-70, 20], [-70, -20]]])))
        self.refuse("mesh", "in.geojson", "--area", "1e12", says=["60 degrees", "part of it"])

    def test_a_raster_of_degrees_serves_a_domain_around_a_pole(self):
        rows = ["ncols 72", "nrows 13", "xllcenter -177.5", "yllcenter 60", "cellsize 5", "dx 5", "dy 2.5"]
        rows.remove("cellsize 5")
        rows += [" ".join(str(100 * (90 - latitude)) for _ in range(72)) for latitude in [90 - 2.5 * k for k in range(13)]]
        self.write("depth.asc", "\n".join(rows) + "\n")
        cap = [[-180, 66], [180, 66], [180, 90], [-180, 90], [-180, 66]]
        self.write("in.geojson", collection(feature("Polygon", [cap])))
        self.succeed("mesh", "in.geojson", "--area", "2e10", "--raster", "depth=depth.asc", "--depth", "depth", "-o", "m.14")
        lines = (self.folder / "m.14").read_text().splitlines()
        for line in lines[2:2 + int(lines[1].split()[1])]:
            _, _, latitude, depth = map(float, line.split())
            # The raster is coarse, and the surface a cone whose tip it cuts.
            self.assertLess(abs(depth - 100 * (90 - latitude)), 100 if latitude > 86 else 25, line)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Every format of meshes, of every kind of mesh: what the program writes, it reads and accepts.

usage: formats_test.py DRIFTMESH [unittest options]
"""

import itertools
import json
import math
import os
import pathlib
import re
import shutil

import program
from program import SQUARE, Cli, main

# Domains, with the bounds of their meshes.
DOMAINS = {
    "pipe": ["--area", "0.05"],
    "bay": ["--area", "400000", "--angle", "25"],
    "comb": ["--area", "0.01"],
    "holes": ["--area", "0.02"],
}
OPTIONS = {"bay": ["--resolution", "1000"], "comb": ["--slits", "9"], "holes": ["--columns", "4", "--rows", "3"]}
PARTS = ([], ["-n", "1"], ["-n", "5"], ["-n", "24"])
OUTPUTS = ("m.vtu", "m.msh", "m.h5", "t.ele")

# Two regions beside a third part without one, a hole, an inner segment with marker 0, attributes and markers of points.
REGIONS = """14 2 2 1
1 0 0 1 -1 1
2 3 0 4 -4 2
3 6 0 7 -7 3
4 9 0 0 0 4
5 9 4 1 1 5
6 6 4 2 2 0
7 3 4 3 3 7
8 0 4 4 4 -8
9 1 1 5 5 9
10 2 1 6 6 9
11 2 2 7 7 9
12 1 2 8 8 9
13 4 2 9 9 0
14 5 3 1 2 0
15 1
1 1 2 1
2 2 3 2
3 3 4 3
4 4 5 4
5 5 6 0
6 6 7 -6
7 7 8 7
8 8 1 8
9 2 7 0
10 3 6 20
11 9 10 30
12 10 11 30
13 11 12 30
14 12 9 31
15 13 14 0
1
1 1.5 1.5
2
1 0.5 0.5 2.5 0.05
2 8 2 -7 0.2
"""


SQUARE_WITH_HOLE = """8 2 0 0
1 0 0
2 1 0
3 1 1
4 0 1
5 0.4 0.4
6 0.6 0.4
7 0.6 0.6
8 0.4 0.6
8 1
1 1 2 1
2 2 3 2
3 3 4 3
4 4 1 4
5 5 6 5
6 6 7 5
7 7 8 5
8 8 5 5
1
1 0.5 0.5
"""


def digest_of(said):
    return re.search(r"^digest +([0-9a-f]{16})$", said, re.MULTILINE).group(1)


class Formats(Cli):
    def domains(self):
        for kind, bounds in DOMAINS.items():
            self.succeed("generate", kind, *OPTIONS.get(kind, []), "-o", "in.poly")
            yield kind, bounds
        self.write("in.poly", REGIONS)
        yield "regions", ["--area", "0.1"]

    def test_check_accepts_every_format(self):
        separators = 0
        for (kind, bounds), parts in itertools.product(self.domains(), PARTS):
            with self.subTest(domain=kind, parts=parts):
                outputs = [*OUTPUTS, "p.pvtu"]
                said = self.succeed("mesh", "in.poly", *bounds, *parts, *itertools.chain(*(["-o", o] for o in outputs)))
                for output in outputs:
                    checked = self.succeed("check", output, "in.poly", *bounds)
                    self.assertIn("accepted", checked)
                    self.assertEqual(digest_of(checked), digest_of(said))
                separators += (self.folder / "t.poly").read_text().count(" -1000000\n")
                if not parts:
                    self.assertNotIn(" -1000000\n", (self.folder / "t.poly").read_text())
        self.assertGreater(separators, 500)

    def test_check_accepts_what_was_converted(self):
        self.write("in.poly", REGIONS)
        for parts in PARTS:
            self.succeed("mesh", "in.poly", "--area", "0.1", *parts, "-o", "m0.vtu")
            for i, extension in enumerate((".ele", ".msh", ".ele", ".vtu", ".ele", ".vtu")):
                name = f"m{i + 1}{extension}"
                self.succeed("convert", next(self.folder.glob(f"m{i}.[vme][tsl]?")).name, name)
                self.succeed("check", name, "in.poly", "--area", "0.1")
            for path in self.folder.glob("m*"):
                path.unlink()

    def test_a_grid_of_adcirc_has_open_land_and_island_boundaries(self):
        self.write("in.poly", SQUARE_WITH_HOLE)
        self.succeed("mesh", "in.poly", "--area", "0.01", "--open-boundary", "4,2", "-o", "fort.14", "-o", "m.vtu")
        said = self.succeed("check", "fort.14")
        self.assertEqual(digest_of(said), digest_of(self.succeed("check", "m.vtu")))
        # Sides 4 and 2 of the square, each a string, and the other two between them; the hole is an island.
        lines = (self.folder / "fort.14").read_text().splitlines()
        self.assertIn("2 = number of open boundaries", lines)
        self.assertIn("3 = number of land boundaries", lines)
        self.assertEqual(sum(" 1 = number of nodes of this island" in line for line in lines), 1)
        self.succeed("convert", "m.vtu", "hgrid.gr3", "--open-boundary", "2,4")
        self.assertEqual((self.folder / "hgrid.gr3").read_text(), (self.folder / "fort.14").read_text())
        self.succeed("convert", "hgrid.gr3", "again.vtu")
        self.assertIn(" on the boundary", self.succeed("check", "again.vtu"))
        self.refuse("convert", "m.vtu", "x.14", "--open-boundary", "2,sea", code=2, says=["--open-boundary", "sea"])
        self.refuse("mesh", "in.poly", "-o", "x.14", "--open-boundary", "2.5", code=2, says=["open-boundary", "whole number"])

    def test_names_go_through_all_files_that_hold_them(self):
        self.write("in.poly", REGIONS)
        named = ["--marker-name", "1=inlet", "--marker-name", "-6=in let", "--region-name", "2.5=land & sea"]
        for i, parts in enumerate(PARTS[1:3]):
            said = self.succeed("mesh", "in.poly", "--area", "0.1", *parts, *named, "-o", f"{i}.vtu", "-o", f"{i}.pvtu")
            self.assertIn("-6=in let", said)  # in the line that repeats the command
            self.succeed("convert", f"{i}.pvtu", "a.h5")
            self.succeed("convert", "a.h5", "b.msh", "--ascii")
            self.succeed("convert", "b.msh", "c.vtu")
            self.succeed("convert", "c.vtu", "d.su2", "--marker-name", "1=out(let)")
            names = lambda file, text: text in (self.folder / file).read_bytes()
            for file, text in (("c.vtu", b'Name="in let"'), ("c.vtu", b'Name="land &amp; sea"'), ("b.msh", b'"land & sea"'),
                               ("d.su2", b"MARKER_TAG= in_let\n"), ("d.su2", b"MARKER_TAG= out_let_\n")):
                self.assertTrue(names(file, text), (file, text))
            self.succeed("convert", "d.su2", "e.su2")
            self.assertEqual((self.folder / "d.su2").read_bytes(), (self.folder / "e.su2").read_bytes())
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "--area", "0.01", "-o", "s.su2")
        self.assertIn("accepted", self.succeed("check", "s.su2", "square.poly", "--area", "0.01"))
        self.write("coast.geojson", json.dumps({"type": "Feature", "properties": {"marker": 4, "name": "reef"}, "geometry":
                                                {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}}))
        self.succeed("mesh", "coast.geojson", "-o", "f.su2")
        self.assertIn("MARKER_TAG= reef\n", (self.folder / "f.su2").read_text())
        self.refuse("mesh", "in.poly", "--marker-name", "x=inlet", "-o", "x.vtu", code=2, says=["--marker-name", "'x'"])
        self.refuse("mesh", "in.poly", "--marker-name", "1=", "-o", "x.vtu", says=["in.poly", "is empty"])
        self.refuse("mesh", "in.poly", "--marker-name", "1=a", "--region-name", "2.5=a", "-o", "x.vtu", says=["'a' is given twice"])
        self.refuse("convert", "c.vtu", "x.msh", "--marker-name", "1.5=a", code=2, says=["--marker-name", "1.5=a"])
        self.refuse("convert", "c.vtu", "x.msh", "--region-name", "2.5=domain", says=["x.msh", "'domain'"])

    def test_segments_inside_can_be_left_out(self):
        self.write("in.poly", REGIONS)
        self.succeed("mesh", "in.poly", "--area", "0.1", "-o", "m.vtu")
        self.succeed("convert", "m.vtu", "all.ele")
        self.succeed("convert", "m.vtu", "rim.ele", "--boundary-only")
        segments = lambda name: [line.split() for line in (self.folder / name).read_text().splitlines()[2:-1]]
        sides = [frozenset(pair) for line in (self.folder / "rim.ele").read_text().splitlines()[1:]
                 if not line.startswith("#") for pair in itertools.combinations(line.split()[1:4], 2)]
        expected = [row[1:] for row in segments("all.poly") if sides.count(frozenset(row[1:3])) == 1]
        self.assertEqual([row[1:] for row in segments("rim.poly")], expected)
        self.assertLess(len(expected), len(segments("all.poly")))

    def test_files_of_ranks_are_refused_in_one_process(self):
        self.write("in.poly", SQUARE)
        self.refuse("mesh", "in.poly", "-o", "x.pmesh", says=["x.pmesh", "mpirun", ".mesh"])
        self.succeed("mesh", "in.poly", "-o", "m.mesh", "-o", "m.vtu")
        self.refuse("convert", "m.vtu", "x.pmesh", says=["x.pmesh", ".mesh"])
        self.succeed("convert", "m.vtu", "again.mesh")
        self.assertEqual((self.folder / "m.mesh").read_text(), (self.folder / "again.mesh").read_text())
        self.succeed("check", "m.mesh", "in.poly")
        self.succeed("convert", "m.vtu", "m.msh", "--order", "rcm")
        self.succeed("check", "m.msh", "in.poly")
        (self.folder / "m.msh").unlink()
        self.refuse("check", "m.pmesh", code=2, says=["is written, but not read"])
        self.assertEqual(self.files(), ["again.mesh", "in.poly", "m.mesh", "m.vtu"])

    def test_separators_are_constraints_in_triangles_files_and_nothing_else(self):
        self.write("in.poly", REGIONS)
        self.succeed("mesh", "in.poly", "--area", "0.1", "-n", "9", "-o", "t.ele", "-o", "m.vtu")
        self.assertIn(" -1000000\n", (self.folder / "t.edge").read_text())
        segments = re.search(r"^subsegments +(\d+)", self.succeed("check", "m.vtu"), re.MULTILINE).group(1)
        self.assertIn(f"subsegments    {segments}", re.sub(r"subsegments +", "subsegments    ", self.succeed("check", "t.ele")))
        self.write("marked.poly", SQUARE)
        self.succeed("mesh", "marked.poly", "--area", "0.01", "-n", "9", "-o", "e.ele")
        os.unlink(self.folder / "e.poly")  # the separators are in e.edge, too
        self.assertIn("accepted", self.succeed("check", "e.ele", "marked.poly"))
        # The .poly of the mesh is a domain again, without them.
        self.succeed("mesh", "t.poly", "-o", "again.ele", "-o", "again.vtu")
        self.assertNotIn(" -1000000\n", (self.folder / "again.poly").read_text())
        self.succeed("check", "again.vtu", "t.poly")

    def test_a_marker_that_stands_for_separators_is_refused(self):
        self.write("in.poly", SQUARE.replace("1 1 2 1", "1 1 2 -1000000"))
        self.succeed("mesh", "in.poly", "-o", "m.vtu")
        self.refuse("mesh", "in.poly", "-o", "t.ele", says=["t.poly", "-1000000", "separators"])
        self.assertEqual(self.files(), ["in.poly", "m.vtu"])


class Coast(Cli):
    def test_a_coast_in_degrees_is_meshed_checked_drawn_and_cut(self):
        shutil.copy(pathlib.Path(__file__).resolve().parents[2] / "examples" / "coast" / "bay.geojson", self.folder)
        said = self.succeed("mesh", "bay.geojson", "--area", "1M", "--open-boundary", "3", "-o", "m.vtu", "-o", "fort.14",
                            "--json", "m.json")
        self.assertIn("in meters, UTM zone 18N", said)
        self.assertIn("10 holes", said)
        self.assertEqual(json.loads((self.folder / "m.json").read_text())["input"]["projection"], "UTM zone 18N")
        self.assertIn("accepted", self.succeed("check", "m.vtu", "bay.geojson", "--area", "1M"))
        self.succeed("plot", "bay.geojson", "-o", "bay.png")
        self.assertIn("Subdomains", self.succeed("decompose", "bay.geojson", "-n", "5"))
        grid = (self.folder / "fort.14").read_text()
        self.assertIn("\n1 = number of open boundaries\n", grid)
        self.assertEqual(grid.count("of this island"), 10)
        # The area of the domain, from the degrees alone: the trapezoids between parallels of a sphere of the right
        # radius there are good to a percent.
        rings = [feature["geometry"]["coordinates"] for feature in
                 json.loads((self.folder / "bay.geojson").read_text())["features"]][1]
        area = 0
        for ring in rings:
            for (x, y), (u, v) in zip(ring, ring[1:]):
                area -= (u - x) * (v + y - 74.6) / 2
        area *= 110_970 * 111_320 * math.cos(math.radians(37.3))
        found = float(re.search(r"([0-9.]+) in total", said).group(1))
        self.assertLess(abs(found / area - 1), 0.01)

    def test_what_is_wrong_is_said_with_the_place(self):
        self.write("a.geojson", '{"type": "Polygon",\n"coordinates": [[[0, 0], [1, 0]')
        self.refuse("mesh", "a.geojson", "-o", "x.vtu", says=["a.geojson:2: is not valid JSON"])
        self.write("b.geojson", '{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 0]]]}')
        self.refuse("mesh", "b.geojson", "-o", "x.vtu", says=["b.geojson: feature 1 has a ring of fewer than three"])
        self.assertEqual(self.files(), ["a.geojson", "b.geojson"])


class NoDomains(Cli):
    def test_what_is_given_as_a_domain_by_mistake_is_named(self):
        self.write("in.poly", SQUARE)
        self.succeed("mesh", "in.poly", "-n", "2", "-o", "m.vtu", "-o", "t.ele")
        self.succeed("decompose", "in.poly", "-n", "2", "-o", "d.parts")
        shutil.copy(self.folder / "m.vtu", self.folder / "vtu.poly")
        for name, kind in (("vtu.poly", "VTK"), ("d.parts", "decomposition")):
            for command in (["mesh", name, "-o", "x.vtu"], ["decompose", name, "-n", "2", "-o", "x"]):
                result = self.refuse(*command, says=[f"{name}: is", kind, "not a domain", ".poly"])
                self.assertNotIn("number of vertices", result.stderr)
            self.refuse("check", "m.vtu", name, code=2, says=[f"{name}: is", kind, "not a domain"])


if __name__ == "__main__":
    main()

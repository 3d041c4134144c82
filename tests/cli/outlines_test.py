#!/usr/bin/env python3
"""Outlines as they come: with duplicates, gaps and slivers, without a border, and as meshes.

usage: outlines_test.py DRIFTMESH [unittest options]
"""

import json
import math
import re

from program import SQUARE, Cli, main


def poly(points, segments, holes=()):
    """Segments are pairs, or triples with a marker."""
    lines = [f"{len(points)} 2 0 0"]
    lines += [f"{i} {x!r} {y!r}" for i, (x, y) in enumerate(points)]
    lines.append(f"{len(segments)} 1")
    lines += [f"{i} {s[0]} {s[1]} {s[2] if len(s) > 2 else 1}" for i, s in enumerate(segments)]
    lines.append(f"{len(holes)}")
    lines += [f"{i} {x!r} {y!r}" for i, (x, y) in enumerate(holes)]
    return "\n".join(lines) + "\n"


def ring(first, count, marker=1):
    return [(first + i, first + (i + 1) % count, marker) for i in range(count)]


class Outlines(Cli):
    def mesh(self, name, *options):
        """The record of a mesh that the check accepts."""
        self.succeed("mesh", name, "-o", "made.vtu", "--json", "made.json", "--quiet", *options)
        checked = [option for option in options if option not in ("-n", "2", "16")]
        self.succeed("check", "made.vtu", name, "--quiet", *checked)
        return json.loads((self.folder / "made.json").read_text())

    def test_duplicates_at_any_power_of_two(self):
        for size in (2.0 ** -30, 0.5, 1.0, 2.0, 2.0 ** 40):
            points = [(-size, -size), (-size, -size), (size, 0.0), (size, size), (0.0, size), (0.0, size)]
            self.write("twice.poly", poly(points, [(0, 2), (2, 3), (3, 4), (5, 1)]))
            for options in ((), ("-n", "16")):
                record = self.mesh("twice.poly", *options)
                self.assertAlmostEqual(record["mesh"]["total_area"] / size ** 2, 2, places=12)

    def test_what_is_closer_at_the_origin_than_the_input_is_exact(self):
        for distance in (1e-28, 1e-16):
            points = [(-1.0, 2.0), (0.0, 0.0), (2.0, -1.0), (2.0, -1.0), (0.0, distance), (-1.0, 2.0)]
            self.write("origin.poly", poly(points, ring(0, 3) + [(3, 4), (4, 5), (5, 3)]))
            for options in ((), ("-n", "2"), ("-n", "16")):
                self.assertLess(self.mesh("origin.poly", *options)["mesh"]["triangles"], 1000)

    def test_a_sliver_takes_few_triangles(self):
        for height in (1e-3, 1e-6, 1e-9):
            self.write("sliver.poly", poly([(0.0, 0.0), (1.0, 0.0), (0.5, height)], ring(0, 3)))
            self.assertLess(self.mesh("sliver.poly")["mesh"]["triangles"], 222)
            self.assertLess(self.mesh("sliver.poly", "-n", "2")["mesh"]["triangles"], 1000)

    def test_a_slit_is_announced_with_its_place_width_and_cost(self):
        self.write("square.poly", SQUARE)
        self.assertNotIn("side by side", self.run_program("mesh", "square.poly", "--area", "0.5").stderr)
        points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (1.0, 1.0), (3.0, 1.0), (1.0, 1.0001), (3.0, 1.0001)]
        self.write("slit.poly", poly(points, ring(0, 4) + [(4, 5), (6, 7)]))
        result = self.run_program("mesh", "slit.poly", "-o", "slit.vtu", "--json", "slit.json")
        announced = re.search(r"near \(([^,]*), ([^)]*)\) two segments of the input that do not touch are 0\.0001 apart "
                              r"and run side by side for 2, which takes about ([\d,]*)", result.stderr)
        self.assertTrue(announced, result.stderr)
        self.assertTrue(1 <= float(announced[1]) <= 3 and abs(float(announced[2]) - 1) < 0.001, result.stderr)
        triangles = json.loads((self.folder / "slit.json").read_text())["mesh"]["triangles"]
        expected = int(announced[3].replace(",", ""))
        self.assertTrue(0.5 < expected / triangles < 2, (expected, triangles))
        self.refuse("mesh", "slit.poly", "--strict", says=["side by side"])
        # A bound that asks for as small triangles anyway: nothing to announce. Welded, nothing is left of it.
        self.assertNotIn("side by side", self.run_program("mesh", "slit.poly", "--angle", "0").stderr)
        self.assertLess(self.mesh("slit.poly", "--snap", "0.001")["mesh"]["triangles"], 1000)

    def test_a_gap_is_named_and_closed(self):
        self.write("gap.poly", poly([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.25)],
                                    [(0, 1), (1, 2), (2, 3), (3, 4)]))
        self.refuse("mesh", "gap.poly", says=["(0, 0) and (0, 0.25) are 0.25 apart", "snapped by more"])
        output = self.succeed("mesh", "gap.poly", "--snap", "0.3", "-o", "closed.vtu")
        self.assertIn("repair", output)
        report = self.run_program("mesh", "gap.poly", "--snap", "0.3").stderr
        self.assertIn("vertices within 0.3 of another merged (the largest move is 0.25): 1", report)
        record = self.mesh("gap.poly", "--snap", "0.3")
        self.assertAlmostEqual(record["mesh"]["total_area"], 16, places=12)
        self.assertEqual(record["input"]["repairs"]["largest_move"], 0.25)

    def test_the_hull(self):
        points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0), (1.0, 0.5), (2.0, 0.5), (1.0, 0.8)]
        self.write("notch.poly", poly(points, [(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 4, 5)] +
                                      [(5, 6, 7), (6, 7, 7), (7, 5, 7)], [(1.2, 0.6)]))
        self.refuse("mesh", "notch.poly")
        for options in ((), ("-n", "2")):
            record = self.mesh("notch.poly", "--hull", "--area", "0.1", *options)
            self.assertAlmostEqual(record["mesh"]["total_area"], 16 - 0.15, places=12)

    def test_a_mesh_is_the_domain_that_it_covers(self):
        points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]
        self.write("frame.poly", poly(points, ring(0, 4, 3) + ring(4, 4, 7), [(1.5, 1.5)]))
        for name in ("frame.vtu", "frame.msh", "frame.14", "frame.gr3", "frame.pvtu"):
            self.succeed("mesh", "frame.poly", "--area", "0.3", "-o", name, "--quiet")
            for options in ((), ("-n", "2")):
                record = self.mesh(name, "--area", "0.05", *options)
                self.assertAlmostEqual(record["mesh"]["total_area"], 15, places=12)
                self.assertEqual(record["input"]["holes"], 1)
        self.succeed("decompose", "frame.vtu", "-n", "2", "-o", "frame.parts")
        self.write("no.vtu", "not a mesh")
        self.refuse("mesh", "no.vtu", says=["no.vtu"])
        self.refuse("mesh", "frame.pmesh", says=["is written, but not read"])
        self.refuse("mesh", "frame.vtu", "--layers", "a", says=["is a mesh, which has no layers"])
        self.refuse("mesh", "frame.vtu", "-o", "frame.vtu", says=["frame.vtu"])

    def test_an_outline_turns_and_snaps_alike(self):
        """The same polygon, turned, with each corner given twice a little apart: the area of the exact one, about."""
        for degrees in (0, 17, 45, 90):
            turn = math.radians(degrees)
            points = []
            for x, y in ((0, 0), (7, 0), (7, 3), (2, 3)):
                for shift in (0, 0.001):
                    points.append((x * math.cos(turn) - y * math.sin(turn) + shift,
                                   x * math.sin(turn) + y * math.cos(turn)))
            self.write("turned.poly", poly(points, [(0, 2), (3, 4), (5, 6), (7, 1)]))
            self.refuse("mesh", "turned.poly", says=["0.001 apart"])
            record = self.mesh("turned.poly", "--snap", "0.002")
            self.assertAlmostEqual(record["mesh"]["total_area"], 18, delta=0.001 * 20)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The program end to end: generate, mesh, check, plot, convert; and its error messages.

usage: cli_test.py DRIFTMESH [unittest options]
"""

import csv
import functools
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import time

import program
from program import MESHER_SECONDS, RANKS_ENVIRONMENT, SQUARE, Cli, main, without_progress

# Options that keep each kind of input small.
KINDS = {
    "pipe": [],
    "cylinder-flow": [],
    "bay": ["--resolution", "1000"],
    "fan": ["--wedges", "12"],
    "comb": ["--slits", "9"],
    "holes": ["--columns", "4", "--rows", "3"],
    "rectangle-hole": [],
    "random-polygon": ["--vertices", "200"],
    "random-points": ["--points", "300", "--segments", "60"],
}


UNIT_SQUARE = "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n"
# A square of side 4 around a square hole of side 1: markers 1 and 2.
ISLAND = """8 2 0 0
1 0 0
2 4 0
3 4 4
4 0 4
5 1 1
6 2 1
7 2 2
8 1 2
8 1
1 1 2 1
2 2 3 1
3 3 4 1
4 4 1 1
5 5 6 2
6 6 7 2
7 7 8 2
8 8 5 2
1
1 1.5 1.5
"""


class Pipeline(Cli):
    def test_every_kind_of_input_gives_a_mesh_that_check_accepts(self):
        for kind, options in KINDS.items():
            with self.subTest(kind=kind):
                self.succeed("generate", kind, *options, "-o", "in.poly")
                self.succeed("mesh", "in.poly", "--angle", "20", "-o", "out.vtu")
                self.assertIn("accepted", self.succeed("check", "out.vtu", "in.poly", "--angle", "20"))

    def test_the_whole_way(self):
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        self.succeed("mesh", "bay.poly", "--area", "500000", "--angle", "25", "-o", "bay.vtu", "-o", "bay.msh", "--json",
                     "run.json")
        json.loads((self.folder / "run.json").read_text())
        bounds = ["--area", "500000", "--angle", "25"]
        for mesh in ("bay.vtu", "bay.msh"):
            self.succeed("check", mesh, "bay.poly", *bounds)
        self.succeed("convert", "bay.vtu", "copy.ele")
        self.succeed("check", "copy.ele", "bay.poly", *bounds)
        self.succeed("convert", "copy.ele", "again.vtu")
        self.succeed("check", "again.vtu", "bay.poly", *bounds)
        for picture, magic in (("bay.png", b"\x89PNG"), ("bay.svg", b"<?xml")):
            self.succeed("plot", "bay.vtu", "-o", picture)
            self.assertTrue((self.folder / picture).read_bytes().startswith(magic))
        self.succeed("plot", "bay.poly", "-o", "input.png")
        self.assertFalse([name for name in self.files() if "tmp" in name])

    def test_narrow_features_of_sizes_are_met_and_checked(self):
        self.write("unit.poly", UNIT_SQUARE)
        self.write_background(60, {(17, 23), (40, 41), (55, 3)}, 0.005, 0.3)
        for options, elsewhere, least in ((["--size", "0.3-0.29*exp(-((x-.6)^2+(y-.3)^2)*1000)"], 0.28, 80),
                                          (["--size", "1e-3+10*abs(y-0.5)"], 2, 4000),
                                          (["--size", "0.2-0.199*exp(-((x-.6123)^2+(y-.3377)^2)*1e6)"], 0.19, 120),
                                          (["--size-mesh", "background.node"], 0.28, 150)):
            with self.subTest(options=options):
                for parts in [], ["-n", "8"]:
                    self.succeed("mesh", "unit.poly", *options, *parts, "-o", "out.vtu", "--json", "run.json")
                    self.assertGreater(json.loads((self.folder / "run.json").read_text())["mesh"]["triangles"], least)
                    self.assertIn("accepted", self.succeed("check", "out.vtu", "unit.poly", *options, "--angle", "20",
                                                             "--size-resolution", "1000"))
                # What is right at the corners is not enough.
                self.succeed("mesh", "unit.poly", "--size-max", elsewhere, "-o", "coarse.vtu")
                rejected = self.run_program("check", "coarse.vtu", "unit.poly", *options)
                self.assertEqual(rejected.returncode, 1, rejected.stdout)
                self.assertIn("is asked for at (", rejected.stdout)

    def test_sizes_that_depend_on_the_distance_to_a_boundary(self):
        self.write("island.poly", ISLAND)
        size = ["--size", "0.05 + 0.3 * distance(2)"]
        self.succeed("mesh", "island.poly", *size, "--size-max", "0.4", "--subdomains", "1", "-o", "one.vtu")
        threads = ["mesh", "island.poly", *size, "-n", "6", "-o", "threads.vtu", "--json", "run.json"]
        self.assertIn("6 subdomains on 2 threads", self.succeed(*threads, "--threads", "2"))
        run = json.loads((self.folder / "run.json").read_text())
        self.succeed("mesh", "island.poly", "--size", "0.05 + 0.3 * hypot(max(1-x, x-2, 0), max(1-y, y-2, 0))", "-n", "6",
                     "-o", "formula.vtu", "--json", "formula.json")
        formula = json.loads((self.folder / "formula.json").read_text())
        for kind, number in ("mesh", "triangles"), ("work", "forecast_triangles"):  # bounds on a formula differ a bit
            self.assertAlmostEqual(run[kind][number] / formula[kind][number], 1, delta=0.02)
        self.assertLess(abs(run["work"]["forecast_triangles"] / run["mesh"]["triangles"] - 1), 0.3)
        result = self.on_ranks(2, "mesh", "island.poly", *size, "-n", "6", "-o", "ranks.pvtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.write("run.yaml", f"input: island.poly\nsize: {size[1]}\noutput: [yaml.vtu]\n")
        self.succeed("mesh", "--config", "run.yaml")
        for mesh in "one.vtu", "threads.vtu", "ranks.pvtu", "yaml.vtu":
            with self.subTest(mesh=mesh):
                self.assertIn("accepted", self.succeed("check", mesh, "island.poly", *size, "--angle", "20"))
                rejected = self.run_program("check", mesh, "island.poly", "--size", "0.03 + 0.1 * distance(2)")
                self.assertEqual(rejected.returncode, 1, rejected.stdout)
        self.succeed("mesh", "island.poly", *size, "--gradation", "0.2", "-o", "graded.vtu")
        self.assertIn("accepted", self.succeed("check", "graded.vtu", "island.poly", *size, "--gradation", "0.2"))
        self.refuse("mesh", "island.poly", "--size", "1 + distance(3)", "-o", "none.vtu",
                    says=["no segment has the marker 3", "1, 2"])
        self.refuse("mesh", "island.poly", "--size", "1 + distance(x)", says=["column 14", "whole numbers"])
        self.refuse("check", "one.vtu", *size, code=2, says=["no segments", "give an input"])

    def test_a_line_of_tiny_sizes_is_met_or_stopped_by_a_limit(self):
        self.write("unit.poly", UNIT_SQUARE)
        self.refuse("mesh", "unit.poly", "--size", "1e-6+10*abs(y-0.5)", "--max-triangles", "100k", "-o", "out.vtu", code=3,
                    says=["--max-triangles"])
        self.assertEqual(self.files(), ["unit.poly"])

    def test_a_background_mesh_that_does_not_cover_the_domain_is_a_warning(self):
        self.write("square.poly", SQUARE)  # 4 by 4
        self.write("unit.poly", UNIT_SQUARE)
        self.write_background(4, set(), 0.2, 0.2)
        for parts in [], ["-n", "4"]:
            result = self.run_program("mesh", "square.poly", "--size-mesh", "background.node", *parts, "--json", "run.json")
            self.assertEqual(result.returncode, 0, result.stderr)
            warnings = json.loads((self.folder / "run.json").read_text())["input"]["warnings"]
            self.assertEqual(len(warnings), 1)
            self.assertIn(warnings[0], result.stdout)
            x, y = map(float, re.search(r"not cover the domain, for example not at \((.*), (.*)\);", warnings[0]).groups())
            self.assertTrue(0 <= x <= 4 and 0 <= y <= 4 and (x > 1 or y > 1))
        self.refuse("mesh", "square.poly", "--size-mesh", "background.node", "--strict", says=["does not cover the domain"])
        self.succeed("mesh", "unit.poly", "--size-mesh", "background.node", "--strict")

    def write_background(self, n, fine, length, others):
        """A grid of n x n squares over the unit square, with `length` at the points `fine`."""
        points = [(i, j) for j in range(n + 1) for i in range(n + 1)]
        self.write("background.node", f"{len(points)} 2 1 0\n" + "".join(
            f"{k} {i / n} {j / n} {length if (i, j) in fine else others}\n" for k, (i, j) in enumerate(points)))
        corners = [j * (n + 1) + i for j in range(n) for i in range(n)]
        triangles = [t for a in corners for t in ((a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1))]
        self.write("background.ele", f"{len(triangles)} 3 0\n" + "".join(
            f"{k} {a} {b} {c}\n" for k, (a, b, c) in enumerate(triangles)))

    def test_decompositions(self):
        for kind, options in KINDS.items():
            if kind == "random-points":
                continue  # its segments need not enclose anything
            with self.subTest(kind=kind):
                self.succeed("generate", kind, *options, "-o", "in.poly")
                said = self.succeed("decompose", "in.poly", "-n", "12", "-o", "out.parts")
                self.assertIn("12, ", said)
                self.assertTrue((self.folder / "out.parts").read_text().startswith("# driftmesh decomposition 2\n"))
        first = (self.folder / "out.parts").read_bytes()
        self.succeed("decompose", "in.poly", "-n", "12", "-o", "again.parts", "--quiet")
        self.assertEqual(first, (self.folder / "again.parts").read_bytes())
        self.succeed("decompose", "in.poly", "-n", "12", "--size", "0.1 + 0.01 * x", "--split-skew", "0.5", "--seed", "3",
                     "--plot", "out.png")
        self.assertTrue((self.folder / "out.png").read_bytes().startswith(b"\x89PNG"))

    def test_decompositions_that_are_refused(self):
        self.write("square.poly", SQUARE)
        self.refuse("decompose", "square.poly", "-n", "0", "-o", "a", code=2, says=["--subdomains"])
        self.refuse("decompose", "square.poly", "-o", "a", code=2, says=["--subdomains"])
        self.refuse("decompose", "none.poly", "-n", "2", "-o", "a", says=["none.poly"])
        self.refuse("decompose", "square.poly", "-n", "2", "-o", "no/folder/a", says=["no/folder/a"])
        self.refuse("decompose", "square.poly", "-n", "2", "-o", "square.poly", says=["square.poly", "INPUT"])
        self.assertEqual((self.folder / "square.poly").read_text(), SQUARE)
        self.assertEqual(self.files(), ["square.poly"])

    def test_a_decomposition_of_another_input_is_refused(self):
        self.write("square.poly", SQUARE)
        self.write("crossed.poly", SQUARE.replace("\n4 1\n", "\n5 1\n").replace("\n0\n", "\n5 1 3 0\n0\n"))
        self.succeed("decompose", "square.poly", "-n", "3", "-o", "square.parts")
        self.refuse("mesh", "crossed.poly", "--decomposition", "square.parts", "--area", "0.05", "-o", "x.vtu",
                    says=["square.parts", "another input"])
        self.assertNotIn("x.vtu", self.files())

    def test_pictures_by_option(self):
        self.write("square.poly", SQUARE)
        self.write("points.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n")
        self.succeed("mesh", "square.poly", "--area", "0.01", "-o", "square.msh")
        self.succeed("plot", "square.msh")
        self.succeed("plot", "square.msh", "-o", "a.svg", "--color", "region", "--edges", "on", "--pixels", "640x480",
                     "--title", "A square")
        self.succeed("plot", "square.msh", "-o", "a.pdf", "--color", "area", "--box", "0.2,0.2,0.4,0.4")
        self.succeed("plot", "points.node", "--color", "none", "--edges", "off")
        self.succeed("plot", "square.poly", "--size", "0.1 + 0.3*distance()", "--size-max", "0.4", "-o", "sizes.svg")
        # A mesh stands for its outline.
        self.succeed("plot", "square.msh", "--size", "0.1 + 0.3*distance()", "--size-max", "0.4", "-o", "again.svg")
        for picture in "sizes.svg", "again.svg":
            self.assertIn("data:image/png;base64,", (self.folder / picture).read_text())
        self.refuse("plot", "square.poly", "--size", "640x480", "-o", "b.png", code=2, says=["--pixels WxH"])
        self.refuse("plot", "square.poly", "--gradation", "0.2", "-o", "b.png", code=2, says=["--size", "--size-mesh"])
        self.refuse("plot", "square.poly", "--size", "depth", "-o", "b.png", says=["depth"])
        self.assertFalse((self.folder / "b.png").exists())
        for picture, start in (("square.png", b"\x89PNG"), ("a.pdf", b"%PDF"), ("points.png", b"\x89PNG")):
            self.assertTrue((self.folder / picture).read_bytes().startswith(start), picture)
        self.assertIn('width="640', (self.folder / "a.svg").read_text())
        before = self.files()
        for options, word in ((["--color", "blue"], "blue"), (["--pixels", "640"], "WIDTHxHEIGHT"),
                              (["--box", "1,1,0,0"], "x0 < x1")):
            self.refuse("plot", "square.msh", "-o", "b.png", *options, code=2, says=[word])
        self.refuse("plot", "square.msh", "-o", "b.png", "--width", "20", code=2, says=["--width", "100 to 20000"])
        self.refuse("plot", "square.msh", "-o", "b.png", "--pixels", "20x500", says=["each side may have"])
        for option in "--output", "--title":
            self.refuse("plot", "square.msh", option, "", code=2, says=[option, "is empty"])
        for input in "square.msh", "square.poly":
            self.refuse("plot", input, "-o", "b.png", "--box", "5,5,6,6", says=[input, "box", "from (0, 0) to (4, 4)"])
        self.assertEqual(self.files(), before)

    def test_options_may_stand_before_the_input(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "-o", "a.vtu", "-o", "b.vtu", "square.poly")
        self.assertEqual(self.files(), ["a.vtu", "b.vtu", "square.poly"])

    def test_a_stricter_check_rejects_the_mesh(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "--area", "0.5", "-o", "square.vtu")
        self.succeed("check", "square.vtu", "square.poly", "--area", "0.5", "--angle", "20")
        for bound in (["--area", "0.05"], ["--angle", "59"]):
            result = self.run_program("check", "square.vtu", "square.poly", *bound)
            self.assertEqual(result.returncode, 1)
            self.assertIn("rejected", result.stdout)

    def test_a_mesh_of_another_domain_is_rejected(self):
        self.write("square.poly", SQUARE)
        self.write("wide.poly", SQUARE.replace("2 4 0", "2 5 0").replace("3 4 4", "3 5 4"))
        self.succeed("mesh", "square.poly", "--area", "0.5", "-o", "square.vtu")
        self.assertEqual(self.run_program("check", "square.vtu", "wide.poly").returncode, 1)

    def test_the_same_input_gives_the_same_file(self):
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        for name in ("one.vtu", "two.vtu"):
            self.succeed("mesh", "bay.poly", "--area", "400000", "-o", name)
        self.assertEqual((self.folder / "one.vtu").read_bytes(), (self.folder / "two.vtu").read_bytes())

    def test_carriage_returns_change_nothing(self):
        self.write("unix.poly", SQUARE)
        self.write("dos.poly", SQUARE.replace("\n", "\r\n"))
        for name in ("unix", "dos"):
            self.succeed("mesh", f"{name}.poly", "--area", "0.5", "-o", f"{name}.vtu")
        self.assertEqual((self.folder / "unix.vtu").read_bytes(), (self.folder / "dos.vtu").read_bytes())

    def test_vertices_in_a_file_of_their_own(self):
        lines = SQUARE.splitlines(keepends=True)
        self.write("square.node", "".join(lines[:5]))
        self.write("square.poly", "0 2 0 0\n" + "".join(lines[5:]))
        self.succeed("mesh", "square.poly", "--area", "0.5", "-o", "out.vtu")
        self.succeed("check", "out.vtu", "square.poly", "--area", "0.5")


class TinyDomains(Cli):
    """Midpoints as small as 1e-52 are read back, from a mesh and as an input."""

    def test_every_format(self):
        corners = [(-1e-36, -1e-36), (1.0000000000000002e-36, -1e-36), (1e-36, 1e-36), (-1e-36, 1e-36)]
        self.write("tiny.poly", "4 2 0 0\n" + "".join(f"{i + 1} {x!r} {y!r}\n" for i, (x, y) in enumerate(corners)) +
                   "4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        for arguments in (), ("-n", "3"):
            self.succeed("mesh", "tiny.poly", "--area", "1e-73", *arguments, "-o", "m.poly", "-o", "m.msh", "-o", "m.vtu")
            if not arguments:
                self.assertRegex((self.folder / "m.node").read_text(), r"\de-5[12]")
            for mesh in "m.ele", "m.msh", "m.vtu":
                self.succeed("check", mesh, "tiny.poly", "--angle", "20")
            (self.folder / "m.node").rename(self.folder / "again.node")
            (self.folder / "m.poly").rename(self.folder / "again.poly")
            self.succeed("mesh", "again.poly", "-o", "again.vtu")
            self.succeed("check", "again.vtu", "again.poly", "--angle", "20")


class DomainWarnings(Cli):
    # A chain beside a square, and a ring in it.
    TEXT = """10 2 0 0
1 0 0
2 4 0
3 4 4
4 0 4
5 5 0
6 6 1
7 6 2
8 1 1
9 2 1
10 2 2
9 0
1 1 2
2 2 3
3 3 4
4 4 1
5 5 6
6 6 7
7 8 9
8 9 10
9 10 8
0
"""

    def test_warnings_are_in_the_summary_and_the_record(self):
        self.write("odd.poly", self.TEXT)
        for arguments in (), ("-n", "3"):
            summary = self.succeed("mesh", "odd.poly", *arguments, "--json", "run.json", "-o", "odd.vtu")
            warnings = json.loads((self.folder / "run.json").read_text())["input"]["warnings"]
            self.assertEqual(len(warnings), 2)
            self.assertIn("open at vertex 5 (5, 0)", warnings[0])
            self.assertIn("at vertex 8 (1, 1)", warnings[1])
            for warning in warnings:
                self.assertIn(warning, summary)
            (self.folder / "run.json").unlink()

    def test_strict_makes_them_errors(self):
        self.write("odd.poly", self.TEXT)
        for arguments in ("mesh",), ("mesh", "-n", "3"), ("decompose", "-n", "3"):
            self.refuse(arguments[0], "odd.poly", *arguments[1:], "--strict", "-o", "odd.vtu",
                        says=["odd.poly", "2 segments", "vertex 5 (5, 0)"])
        self.assertEqual(self.files(), ["odd.poly"])

    def test_nested_rings_are_holes_where_asked_for(self):
        self.write("odd.poly", self.TEXT)
        self.assertIn("15.5 in total", self.succeed("mesh", "odd.poly", "--holes", "nested", "-o", "odd.vtu"))
        self.succeed("check", "odd.vtu", "odd.poly", "--holes", "nested")
        self.assertEqual(self.run_program("check", "odd.vtu", "odd.poly").returncode, 1)


class Errors(Cli):
    def test_ranks_with_other_options(self):
        self.succeed("generate", "pipe", "-o", "pipe.poly")
        for option, others in (("--area", ["-a", "0.02"]), ("--output", ["-o", "other.vtu"]), ("INPUT", ["none.poly"])):
            first = ["mesh", "pipe.poly", "-a", "0.01", "-o", "x.vtu"]
            second = ["mesh", *(others if option == "INPUT" else ["pipe.poly"]),
                      *(others if option == "--area" else ["-a", "0.01"]), *(others if option == "--output" else ["-o", "x.vtu"])]
            done = subprocess.run(["mpiexec", "-n", "1", program.PATH, *first, ":", "-n", "1", program.PATH, *second], cwd=self.folder,
                                  capture_output=True, text=True, timeout=MESHER_SECONDS, check=False, env=RANKS_ENVIRONMENT)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(f"{option} differs between ranks: ", done.stderr)
            self.assertEqual(done.stderr.count("driftmesh: "), 1, done.stderr)
            self.assertEqual(self.files(), ["pipe.poly"])

    def test_help(self):
        for command in ([], ["mesh"], ["check"], ["generate"], ["generate", "bay"], ["plot"], ["convert"]):
            self.assertIn("Usage", self.succeed(*command, "--help"))

    def test_the_command_line(self):
        self.write("square.poly", SQUARE)
        for arguments in ([], ["mish"], ["mesh"], ["mesh", "square.poly", "--no-such-option"],
                          ["mesh", "square.poly", "--angle", "many", "-o", "x.vtu"]):
            with self.subTest(arguments=arguments):
                result = self.run_program(*arguments)
                self.assertNotIn(result.returncode, (0, -6, -11), result.stderr)
                self.assertTrue(result.stderr.strip())

    def test_bounds_out_of_range(self):
        self.write("square.poly", SQUARE)
        for bound in (["--angle", "50"], ["--angle", "-1"], ["--angle", "nan"], ["--area", "-1"], ["--area", "nan"]):
            with self.subTest(bound=bound):
                result = self.run_program("mesh", "square.poly", *bound, "-o", "x.vtu")
                self.assertGreater(result.returncode, 0)
                self.assertTrue(result.stderr.strip())
                self.assertNotIn("x.vtu", self.files())

    def test_missing_files(self):
        self.refuse("mesh", "gone.poly", "-o", "x.vtu", says=["gone.poly", "No such file"])
        self.refuse("check", "gone.vtu", code=2, says=["gone.vtu", "No such file"])
        self.refuse("plot", "gone.vtu", "-o", "x.png", says=["gone.vtu", "No such file"])
        self.refuse("convert", "gone.vtu", "x.msh", says=["gone.vtu", "No such file"])

    def test_outputs_that_cannot_be_written(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "-o", "square.vtu")
        (self.folder / "folder.vtu").mkdir()
        before = self.files()
        self.refuse("mesh", "square.poly", "-o", "gone/x.vtu", says=["gone"])
        self.refuse("mesh", "square.poly", "-o", "folder.vtu", says=["folder.vtu"])
        self.refuse("mesh", "square.poly", "-o", "x.docx", says=["x.docx"])
        self.refuse("plot", "square.vtu", "-o", "gone/x.png", says=["gone"])
        self.refuse("plot", "square.vtu", "-o", "x.jpg", says=["x.jpg"])
        self.refuse("convert", "square.vtu", "gone/x.msh", says=["gone"])
        self.refuse("generate", "bay", "-o", "gone/x.poly", says=["gone"])
        self.assertEqual(self.files(), before)

    def test_inputs_that_are_wrong_are_named_with_their_line(self):
        lines = SQUARE.splitlines(keepends=True)
        cases = {
            "empty": ("", ""),
            "truncated": ("".join(lines[:7]), ""),
            "nan": (SQUARE.replace("3 4 4", "3 nan 4"), ":4:"),
            "huge": (SQUARE.replace("3 4 4", "3 1e300 4"), ""),
            "word": (SQUARE.replace("3 4 4", "3 four 4"), ":4:"),
            "no such vertex": (SQUARE.replace("3 3 4 3", "3 3 9 3"), ":9:"),
            "binary": (bytes(range(256)) * 20, ""),
            "many points announced": (SQUARE.replace("4 2 0 0", "4000000000 2 0 0", 1), ""),
        }
        for name, (text, place) in cases.items():
            with self.subTest(name=name):
                path = self.write(name.replace(" ", "_") + ".poly", text)
                self.refuse("mesh", path, "-o", "x.vtu", says=[path + place])
                self.assertNotIn("x.vtu", self.files())

    def test_an_open_boundary_is_refused_with_its_cause(self):
        self.write("open.poly", SQUARE.replace("4 1\n", "3 1\n", 1).replace("4 4 1 4\n", ""))
        self.refuse("mesh", "open.poly", "-o", "x.vtu", says=["boundary is open", "close"])
        self.assertNotIn("x.vtu", self.files())

    def test_damaged_meshes(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "--area", "0.5", "-o", "square.vtu")
        whole = (self.folder / "square.vtu").read_bytes()
        for size in (0, 10, len(whole) // 2, len(whole) - 200):
            with self.subTest(size=size):
                self.write("cut.vtu", whole[:size])
                self.refuse("check", "cut.vtu", code=2, says=["cut.vtu"])
                self.refuse("convert", "cut.vtu", "x.msh", says=["cut.vtu"])

    def test_a_limit_stops_the_mesher_with_an_explanation(self):
        self.write("square.poly", SQUARE)
        limit = ["mesh", "square.poly", "--area", "0.0001", "--max-triangles", "1000", "-o", "x.vtu"]
        self.refuse(*limit, code=3, says=["--max-triangles", "--keep-incomplete"])
        self.assertNotIn("x.vtu", self.files())
        result = self.refuse(*limit, "--keep-incomplete", code=3, says=["1,000"])
        self.assertIn("INCOMPLETE: stopped by --max-triangles", result.stdout)
        self.succeed("check", "x.vtu", "square.poly")

    def test_a_limit_stops_subdomains_with_an_explanation(self):
        self.write("square.poly", SQUARE)
        mesh = ["mesh", "square.poly", "-n", "4", "--max-triangles", "1000", "-o", "x.vtu"]
        for area in "0.0001", "1e-300":
            self.refuse(*mesh, "--area", area, code=3, says=["more than the 1,000 of --max-triangles"])
        self.refuse(*mesh, "--keep-incomplete", code=2, says=["--keep-incomplete", "in one piece"])
        self.succeed("generate", "comb", "-o", "comb.poly")  # of which less is forecast than it takes
        self.refuse("mesh", "comb.poly", "-n", "4", "--max-triangles", "1500", "-o", "x.vtu", code=3,
                    says=["stopped at 1,", "the 1,500 of --max-triangles"])
        self.assertEqual(self.files(), ["comb.poly", "square.poly"])

    def test_options_that_do_not_apply_are_rejected_and_not_ignored(self):
        self.write("square.poly", SQUARE)
        for options, place in ((["--balance", "zoltan"], "mpirun"), (["--speeds", "1,2,3"], "mpirun"),
                               (["--balance-with", "foo=1"], "mpirun"), (["--sleep"], "--subdomains"),
                               (["--slice", "10"], "--subdomains"), (["--presplit", "off"], "--subdomains"),
                               (["--method", "decoupled"], "--subdomains")):
            with self.subTest(options=options):
                self.refuse("mesh", "square.poly", *options, "-o", "x.vtu", code=2, says=[options[0], place])
        self.refuse("mesh", "--generate-with", "x=1", code=2, says=["--generate-with needs a model", "--generate;"])
        for options in (["--balance", "zoltan"], ["--aggregation", "3"], ["--keep-incomplete"], ["--presplit", "on"],
                        ["--method", "decoupled"], ["--method", "decoupled", "--size", "0.1"],
                        ["--presplit", "off", "--method", "decoupled", "--area", "0.1"]):
            with self.subTest(options=options):
                self.refuse("mesh", "square.poly", "-n", "4", *options, code=2, says=[options[0]])
        self.refuse("decompose", "square.poly", "-n", "4", "--split-skew", "5", code=2, says=["--split-skew", "at most 1"])
        self.assertEqual(self.files(), ["square.poly"])

    def test_sizes_take_units_everywhere(self):
        self.write("square.poly", SQUARE)
        self.write("run.yaml", "input: square.poly\narea: 0.00002k\n")
        digests = {self.digest_of("mesh", *call) for call in (["square.poly", "--area", "0.02"], ["--config", "run.yaml"],
                                                              ["square.poly", "--area", "0.00002k"])}
        self.assertEqual(len(digests), 1)
        self.assertIn("about", self.succeed("decompose", "square.poly", "-n", "4", "--triangles", "2k"))

    def digest_of(self, *arguments):
        return re.search(r"^digest +([0-9a-f]{16})$", self.succeed(*arguments), re.MULTILINE).group(1)

    def test_mesh_has_options_for_all_settings_of_ranks(self):
        self.write("square.poly", SQUARE)
        result = self.on_ranks(2, "mesh", "square.poly", "--area", "0.005", "-n", "12", "--slice", "50", "--balance", "zoltan",
                               "--balance-look", "0.001", "--balance-gap", "0.002", "--balance-interval", "0.1",
                               "--balance-gain", "0.05", "--json", "run.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        request = json.loads((self.folder / "run.json").read_text())["request"]
        self.assertEqual([request[key] for key in ("run.slice", "balance.look", "balance.gain")], [50, 0.001, 0.05])

    def test_a_narrow_slit_stops_the_mesher_with_its_place(self):
        text = SQUARE.replace("4 2 0 0", "8 2 0 0").replace("4 0 4\n4 1\n", "4 0 4\n5 1 2\n6 3 2\n7 1 2.000001\n"
                                                            "8 3 2.000001\n6 1\n").replace("\n0\n", "\n5 5 6 1\n6 7 8 1\n0\n")
        self.write("slit.poly", text)
        self.refuse("mesh", "slit.poly", "--max-triangles", "20000", "-o", "x.vtu", code=3,
                    says=["two segments of the input that do not touch are 1e-06 apart", "side by side for 2,", "near (1, 2",
                          "about 6,000,000 triangles", "--max-triangles"])
        self.assertEqual(self.files(), ["slit.poly"])

    def test_a_mesh_that_memory_does_not_allow_is_refused_at_once(self):
        self.write("square.poly", SQUARE)
        result = self.refuse("mesh", "square.poly", "--area", "1e-9", "--max-memory", "200M", "-o", "x.vtu", code=3,
                             says=["--max-memory", "of memory"])
        self.assertEqual(result.stdout, "")
        self.assertEqual(self.files(), ["square.poly"])

    def test_the_input_is_not_written_over(self):
        self.write("square.poly", SQUARE)
        self.refuse("mesh", "square.poly", "-o", "square.ele", says=["square.poly", "INPUT"])
        self.refuse("mesh", "square.poly", "-o", "./square.node", says=["square.poly", "INPUT"])
        self.refuse("mesh", "square.poly", "-o", "a.vtu", "-o", "./a.vtu", says=["a.vtu", "twice"])
        self.refuse("mesh", "square.poly", "-n", "2", "-o", "a.pvtu", "-o", "a_0.vtu", says=["a_0.vtu", "twice"])
        self.assertEqual((self.folder / "square.poly").read_text(), SQUARE)
        self.assertEqual(self.files(), ["square.poly"])

    def test_an_output_that_has_no_size_is_written_all_the_same(self):
        self.write("square.poly", SQUARE)
        (self.folder / "nowhere.vtu").symlink_to("/dev/null")
        self.assertIn("triangles", self.succeed("mesh", "square.poly", "-o", "nowhere.vtu", "--json", "run.json"))
        self.assertIn("run.json", self.files())

    def test_convert_does_not_write_over_what_it_reads(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "-o", "mesh.ele")
        before = {name: (self.folder / name).read_bytes() for name in self.files()}
        self.refuse("convert", "mesh.ele", "./mesh.node", says=["mesh.node", "OUTPUT would overwrite it, and INPUT"])
        self.assertEqual({name: (self.folder / name).read_bytes() for name in self.files()}, before)

    def test_a_signal_leaves_no_files_behind(self):
        self.write("square.poly", SQUARE)
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                # The last of Triangle's files to be opened is a pipe that nobody reads: the program waits there.
                os.mkfifo(self.folder / "out.neigh")
                # Background jobs of a shell ignore some signals, and so would the program.
                heed = functools.partial(signal.signal, number, signal.SIG_DFL)
                with subprocess.Popen([program.PATH, "mesh", "square.poly", "-o", "out.ele"], cwd=self.folder,
                                      preexec_fn=heed, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL) as mesher:
                    end = time.monotonic() + MESHER_SECONDS
                    while sum("tmp" in name for name in self.files()) < 4 and time.monotonic() < end:
                        time.sleep(0.01)
                    self.assertEqual(sum("tmp" in name for name in self.files()), 4)
                    mesher.send_signal(number)
                    self.assertEqual(mesher.wait(MESHER_SECONDS), -number)
                self.assertEqual(self.files(), ["out.neigh", "square.poly"])
                (self.folder / "out.neigh").unlink()

    def test_settings_files(self):
        self.write("square.poly", SQUARE)
        self.write("typo.yaml", "area: 0.5\nanlge: 25\n")
        self.refuse("mesh", "square.poly", "--config", "typo.yaml", says=["typo.yaml:2:1:", "'anlge'", "'angle'"])
        self.refuse("mesh", "square.poly", "--config", "gone.yaml", says=["gone.yaml", "No such file"])

    def test_wrong_usage(self):
        self.write("square.poly", SQUARE)
        for arguments in (["mesh"], ["mesh", "square.poly", "--gradation", "0.2"], ["convert", "a.vtu"], ["generate"],
                          ["mesh", "square.poly", "--size-max", "1", "--size-min", "2"], ["check"], ["plot"],
                          ["mesh", "square.poly", "--max-memory", "much"], [], ["mish"],
                          ["mesh", "square.poly", "--max-memory", "-1"], ["mesh", "square.poly", "more"]):
            with self.subTest(arguments=arguments):
                self.refuse(*arguments, code=2, says=["driftmesh: ", "--help"])


class Mesh(Cli):
    """The summary and the record of `driftmesh mesh`."""

    def digest(self, text):
        return re.search(r"^digest +([0-9a-f]{16})$", text, re.MULTILINE).group(1)

    def test_the_record_says_what_the_summary_says(self):
        self.write("square.poly", SQUARE)
        summary = self.succeed("mesh", "square.poly", "--area", "0.05", "-o", "out.vtu", "-o", "out.ele",
                               "--plot", "out.png", "--json", "run.json")
        record = json.loads((self.folder / "run.json").read_text())
        self.assertEqual((record["format"], record["version"]), ("driftmesh run", 1))
        mesh = record["mesh"]
        self.assertTrue(mesh["complete"])
        self.assertIn(f"mesh         {mesh['triangles']:,} triangles, {mesh['vertices']:,} vertices", summary)
        self.assertEqual(mesh["digest"], self.digest(summary))
        self.assertEqual(sum(mesh["angles_by_10_degrees"]), 3 * mesh["triangles"])
        self.assertAlmostEqual(mesh["total_area"], 16)
        self.assertLessEqual(mesh["largest_area"], 0.05)
        written = {file["name"]: file["bytes"] for file in record["files"]}
        self.assertEqual(sorted([*written, "run.json", "square.poly"]), self.files())
        for name, size in written.items():
            self.assertEqual((self.folder / name).stat().st_size, size)
        # Vertices - edges + triangles is 1 for a disc.
        edges = (3 * mesh["triangles"] + mesh["subsegments"]) // 2
        self.assertEqual(mesh["vertices"] - edges + mesh["triangles"], 1)

    def test_the_digest_survives_every_format(self):
        self.succeed("generate", "pipe", "-o", "pipe.poly")
        summary = self.succeed("mesh", "pipe.poly", "--angle", "30", "-o", "a.vtu", "-o", "b.msh", "-o", "c.ele")
        for name in ("a.vtu", "b.msh", "c.ele"):
            self.assertEqual(self.digest(self.succeed("check", name)), self.digest(summary))

    def test_the_command_that_repeats_a_run_does(self):
        self.write("my square.poly", SQUARE)
        self.write("run.yaml", "input: my square.poly\narea: 0.01\nsize: 0.2 + 0.1 * x\noutput: [one.vtu]\n")
        summary = self.succeed("mesh", "--config", "run.yaml", "--area", "0.02")
        command = re.search(r"^repeat +driftmesh (.*)$", summary, re.MULTILINE).group(1)
        self.assertIn("--area 0.02", command)
        first = (self.folder / "one.vtu").read_bytes()
        (self.folder / "one.vtu").unlink()
        self.assertEqual(self.digest(self.succeed(*shlex.split(command))), self.digest(summary))
        self.assertEqual((self.folder / "one.vtu").read_bytes(), first)

    def test_exceptions_are_listed_with_cause_and_place(self):
        self.succeed("generate", "fan", "--wedges", "12", "--angle", "5", "-o", "fan.poly")
        summary = self.succeed("mesh", "fan.poly", "--json", "run.json")
        self.assertIn("small angle of the input", summary)
        causes = {item["cause"]: item for item in json.loads((self.folder / "run.json").read_text())["exceptions"]}
        angle = causes["small angle of the input"]
        self.assertGreaterEqual(angle["triangles"], 12)
        self.assertAlmostEqual(angle["worst_angle"], 5, places=6)
        self.assertEqual(angle["places"], [[0.5, 0.5]])

    def test_a_mesh_in_parts_is_the_same_on_any_number_of_ranks(self):
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        digests = set()
        for ranks in 1, 2, 3, 4:
            result = self.on_ranks(ranks, "mesh", "bay.poly", "--area", "20000", "-n", "30", "-o", f"{ranks}.pvtu",
                                   "--json", "run.json")
            self.assertEqual(result.returncode, 0, result.stderr)
            run = json.loads((self.folder / "run.json").read_text())
            digests.add(run["mesh"]["digest"])
            self.assertEqual(len(run["parts"]["ranks"]), ranks)
            self.assertTrue(run["command"].startswith(f"mpirun -n {ranks} driftmesh mesh" if ranks > 1 else
                                                      "driftmesh mesh"), run["command"])
            self.assertEqual(sum(r["interface_splits"] for r in run["parts"]["ranks"]), 0)
            self.assertEqual(sum(r["triangles"] for r in run["parts"]["ranks"]), run["mesh"]["triangles"])
            self.assertEqual(sum(r["subdomains"] for r in run["parts"]["ranks"]), 30)
            self.assertIn(f"digest         {run['mesh']['digest']}",
                          self.succeed("check", f"{ranks}.pvtu", "bay.poly", "--area", "20000", "--angle", "20"))
        self.assertEqual(len(digests), 1)

    def test_ranks_with_threads(self):
        """Their meshes are the same where refinement puts no points on interfaces, and correct where it does."""
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        digests = set()
        for threads in 1, 3:
            for presplit in "on", "off":
                result = self.on_ranks(2, "mesh", "bay.poly", "--area", "20000", "-n", "30", "--presplit", presplit,
                                       "--size", "500+x*x", "--threads", threads, "--sleep", "-o", "m.pvtu", "--json",
                                       "run.json")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn("on 2 ranks of 3 threads;" if threads > 1 else "on 2 ranks;", result.stdout)
                self.assertIn("accepted", self.succeed("check", "m.pvtu", "bay.poly", "--area", "20000", "--angle", "20",
                                                       "--size", "500+x*x"))
                if presplit == "on":
                    digests.add(json.loads((self.folder / "run.json").read_text())["mesh"]["digest"])
        self.assertEqual(len(digests), 1)
        many = self.on_ranks(1, "mesh", "bay.poly", "--threads", "1000")
        self.assertIn("a rank has 1000 threads, but may use only", many.stdout + many.stderr)

    def test_a_mesh_is_the_same_with_any_number_of_threads(self):
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        area = ["--area", "2400"]  # for 800,000 triangles
        files = set()
        for threads in 1, 2, 5:
            said = self.succeed("mesh", "bay.poly", *area, "--threads", threads, "-o", "m.vtu", "-o", "m.pvtu")
            self.assertIn(f"subdomains on {threads} thread{'s' * (threads > 1)}; interfaces cut to size", said)
            files.add((self.folder / "m.vtu").read_bytes() + (self.folder / "m_0.vtu").read_bytes())
        self.assertEqual(len(files), 1)
        for name in "m.vtu", "m.pvtu":
            self.assertIn("accepted", self.succeed("check", name, "bay.poly", *area))
        self.assertNotIn("parts ", self.succeed("mesh", "bay.poly", *area, "--subdomains", "1"))

    def test_rounds_are_the_same_with_any_number_of_threads(self):
        """Where refinement splits interfaces, which nothing cuts to size before."""
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        digests = set()
        for threads in 1, 2, 3:
            self.succeed("mesh", "bay.poly", "-n", "30", "--threads", threads, "-o", "m.vtu", "--json", "run.json")
            run = json.loads((self.folder / "run.json").read_text())
            self.assertGreater(run["parts"]["rounds"], 1)
            self.assertGreater(sum(thread["interface_splits"] for thread in run["parts"]["ranks"]), 0)
            self.assertEqual(len(run["parts"]["ranks"]), threads)
            digests.add(run["mesh"]["digest"])
            self.assertIn("accepted", self.succeed("check", "m.vtu", "bay.poly"))
        self.assertEqual(len(digests), 1)

    def test_a_limit_stops_all_threads(self):
        self.write("square.poly", SQUARE)
        for threads in 1, 3:
            result = self.run_program("mesh", "square.poly", "--area", "1.5e-5", "--size", "0.02-0.018*(x>0.5)", "-n", "40",
                                      "--max-triangles", "900000", "--threads", threads, "-o", "m.vtu")
            self.assertEqual(result.returncode, 3)
            self.assertIn("--max-triangles", result.stderr)
            self.assertEqual([path.name for path in self.folder.glob("m*")], [])

    def test_mapping_by_area_leaves_a_corner_of_small_triangles_to_one_rank(self):
        (self.folder / "square.poly").write_text(SQUARE)
        largest = []
        for options in [], ["--map-by-area"]:
            result = self.on_ranks(2, "mesh", "square.poly", "--size", "x < 0.3 && y < 0.3 ? 0.001 : 0.03", "-n", "60",
                                   "--json", "run.json", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            run = json.loads((self.folder / "run.json").read_text())
            largest.append(max(r["triangles"] for r in run["parts"]["ranks"]) / run["mesh"]["triangles"])
        self.assertLess(largest[0], 0.6)
        self.assertGreater(largest[1], 0.85)

    def test_the_full_protocol_makes_a_mesh_that_check_accepts(self):
        self.succeed("generate", "holes", *KINDS["holes"], "-o", "holes.poly")
        self.succeed("decompose", "holes.poly", "-n", "12", "-o", "holes.decomposition")
        for options in ["--presplit", "off"], ["--presplit", "off", "--aggregation", "1", "--work-order", "backlog"]:
            result = self.on_ranks(3, "mesh", "holes.poly", "--area", "0.01", "--decomposition", "holes.decomposition",
                                   *options, "-o", "holes.pvtu", "-o", "holes.msh", "--json", "run.json")
            self.assertEqual(result.returncode, 0, result.stderr)
            run = json.loads((self.folder / "run.json").read_text())
            self.assertGreater(sum(r["splits_sent"] for r in run["parts"]["ranks"]), 0)
            for mesh in "holes.pvtu", "holes.msh":
                self.succeed("check", mesh, "holes.poly", "--area", "0.01", "--angle", "20")

    def test_the_decoupled_method_sends_nothing_or_fails(self):
        self.succeed("generate", "bay", "--resolution", "1000", "-o", "bay.poly")
        method = ["--method", "decoupled", "-n", "30", "--json", "run.json"]
        result = self.on_ranks(3, "mesh", "bay.poly", "--triangles", "1e6", *method, "-o", "bay.pvtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        run = json.loads((self.folder / "run.json").read_text())
        self.assertEqual(sum(r["splits_sent"] for r in run["parts"]["ranks"]), 0)
        self.succeed("check", "bay.pvtu", "bay.poly", "--angle", "20")
        self.succeed("mesh", "bay.poly", "--triangles", "1e6", *method)
        self.assertEqual(json.loads((self.folder / "run.json").read_text())["mesh"]["digest"], run["mesh"]["digest"])
        before = self.files()
        result = self.on_ranks(3, "mesh", "bay.poly", "--triangles", "5e3", "--angle", "33", *method, "-o", "coarse.pvtu")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("needs another point on its border near (", result.stderr)
        self.refuse("mesh", "bay.poly", "--triangles", "5e3", "--angle", "33", *method, "-o", "coarse.vtu",
                    says=["use the coupled method"])
        self.assertEqual(self.files(), before)

    def test_outlines_can_be_simplified(self):
        self.succeed("generate", "bay", "--resolution", "200", "-o", "bay.poly")
        less = ["--simplify", "500"]
        said = self.succeed("mesh", "bay.poly", *less, "--triangles", "1e4", "--json", "run.json", "-o", "bay.vtu")
        run = json.loads((self.folder / "run.json").read_text())["input"]
        points = int((self.folder / "bay.poly").read_text().split()[0])
        self.assertLess(4 * run["points"], points)
        self.assertGreater(run["simplified"]["points"], points / 2)
        self.assertIn(f"simplified by up to 500: without {run['simplified']['points']:,} points", said)
        self.succeed("check", "bay.vtu", "bay.poly", *less)
        self.assertIn("input point missing", self.run_program("check", "bay.vtu", "bay.poly").stdout)
        self.succeed("decompose", "bay.poly", *less, "-n", "8", "--triangles", "1e4", "-o", "bay.parts")
        result = self.on_ranks(2, "mesh", "bay.poly", *less, "--decomposition", "bay.parts", "--triangles", "1e4", "-o", "parts.vtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.succeed("check", "parts.vtu", "bay.poly", *less)
        self.refuse("mesh", "--generate", "pipe", "--simplify", "1e6", says=["pipe: all of it fits", "give a smaller length"])
        self.refuse("mesh", "bay.poly", "--simplify", "-1", code=2, says=["--simplify", "at least 0"])

    def test_errors_show_what_was_given_as_it_was(self):
        for name in ("bounds.area", "--area", "MeshOptions::max_area"):
            self.refuse("mesh", "--generate", "pipe", "--raster", f"{name}=x", "--size", "1", code=2,
                        says=[f"--raster has the name '{name}'"])
            self.refuse("mesh", f"./{name}.poly", says=[f"./{name}.poly: cannot open"])

    def test_partially_coupled_refinement_is_for_experiments(self):
        mesh = ["mesh", "--generate", "pipe", "--triangles", "5e4", "--method", "pdr", "-o", "pipe.vtu"]
        self.refuse(*mesh, code=2, says=["--method", "must be coupled, rounds or decoupled"])
        self.write("pdr.yaml", "method: pdr\n")
        result = self.on_ranks(2, "mesh", "--generate", "pipe", "--triangles", "5e4", "--config", "pdr.yaml", "-o", "pipe.vtu")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("driftmesh run", result.stderr)

    def test_errors_on_many_ranks_are_printed_once(self):
        for arguments, code, message in ((["mesh", "nothing.poly"], 1, "nothing.poly: cannot open"),
                                         (["mesh", "--such"], 2, "unknown option --such"),
                                         (["mesh", "square.poly", "--decomposition", "no.parts"], 1, "no.parts: cannot"),
                                         (["mesh", "square.poly", "--area", "1e-9", "--max-triangles", "1000"], 3,
                                          "--max-triangles"),
                                         (["mesh", "square.poly", "--speeds", "1,2,3"], 2, "--speeds")):
            (self.folder / "square.poly").write_text(SQUARE)
            result = self.on_ranks(2, *arguments)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertEqual(result.stderr.count("driftmesh: "), 1, result.stderr)
            self.assertIn(message, result.stderr)

    def test_an_error_of_one_rank_alone_is_printed(self):
        result = subprocess.run([program.PATH, "mesh", "square.poly", "--config", "no.yaml"], cwd=self.folder, text=True,
                                capture_output=True, timeout=MESHER_SECONDS, check=False,
                                env=dict(RANKS_ENVIRONMENT, OMPI_COMM_WORLD_RANK="1"))
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertIn("no.yaml: cannot open", result.stderr)

    def test_a_file_that_some_ranks_lack_is_one_error(self):
        self.write("square.poly", SQUARE)
        self.write("sizes.node", "3 2 1 0\n1 -9 -9 1\n2 20 -9 1\n3 -9 20 1\n")
        self.write("sizes.ele", "1 3 0\n1 1 2 3\n")
        mesh = [program.PATH, "mesh", "square.poly", "-n", "8", "--size-mesh", "sizes.node"]
        (self.folder / "elsewhere").mkdir()
        result = subprocess.run(["mpiexec", "-n", "1", *mesh, ":", "-n", "2", "--wdir", str(self.folder / "elsewhere"), *mesh],
                                cwd=self.folder, text=True, capture_output=True, timeout=MESHER_SECONDS, check=False,
                                env=RANKS_ENVIRONMENT)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stderr.count("driftmesh: "), 1, result.stderr)
        self.assertIn("driftmesh: rank 1: sizes.node: cannot open", result.stderr)

    def test_attributes_of_added_points_are_interpolated(self):
        lines = SQUARE.splitlines()
        lines[0] = "4 2 1 0"
        for i in range(1, 5):
            _, x, y = lines[i].split()
            lines[i] += f" {2 * float(x) - float(y)}"
        self.write("square.poly", "\n".join(lines) + "\n")
        self.succeed("mesh", "square.poly", "--area", "0.1", "-o", "out.ele")
        points = [line.split() for line in (self.folder / "out.node").read_text().splitlines()[1:] if line[0] != "#"]
        self.assertGreater(len(points), 100)
        for _, x, y, value, *_ in points:
            self.assertAlmostEqual(float(value), 2 * float(x) - float(y), places=12)

    def test_repairs_are_reported_beside_the_summary(self):
        text = SQUARE.replace("4 2 0 0", "5 2 0 0").replace("4 0 4\n", "4 0 4\n5 4 4\n", 1)
        self.write("square.poly", text)
        result = self.run_program("mesh", "square.poly")
        self.assertEqual(result.returncode, 0)
        self.assertIn("duplicate vertices merged: 1", result.stderr)
        self.assertIn("after 1 repair", result.stdout)

    def test_quiet_prints_nothing_and_no_progress_goes_to_a_file(self):
        self.write("square.poly", SQUARE)
        result = self.run_program("mesh", "square.poly", "--area", "0.01", "--quiet")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        result = self.run_program("mesh", "square.poly", "--area", "0.00002")
        self.assertEqual((result.returncode, without_progress(result.stderr)), (0, ""))

    def test_the_summary_fits_a_terminal(self):
        self.succeed("generate", "fan", "--wedges", "12", "--angle", "5", "-o", "fan.poly")
        for line in self.succeed("mesh", "fan.poly", "--area", "0.001", "-o", "fan.vtu").splitlines():
            self.assertLessEqual(len(line), 100, line)
        for command in ([], ["mesh"], ["check"], ["convert"], ["plot"], ["generate"], ["generate", "bay"]):
            for line in self.succeed(*command, "--help").splitlines():
                self.assertLessEqual(len(line), 100, line)

    def test_the_version(self):
        said = self.succeed("--version")
        self.assertRegex(said, r"^driftmesh \d+\.\d+\.\d+\ncompiler: \w+ \d+\.")
        for library in ("Open MPI v", "Zoltan ", "METIS ", "Boost ", "yaml-cpp ", "cairo ", "fmt ",
                        "nlohmann-json "):
            self.assertRegex(said.split("libraries: ")[1], rf"{library}\d+\.\d")


class RunsOfExperiments(Cli):
    """driftmesh run on shipped experiments."""

    CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
    # Settings that make each of them small.
    SHRUNK = {
        "first-run": ["bounds.triangles=2e4"],
        "paper/table-1": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "paper/table-2": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "paper/table-3": ["input.generate=pipe", "bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "paper/table-3-pdr": ["input.generate=pipe", "bounds.triangles-per-rank=3e3", "cluster.ranks=8"],
        "paper/fig-7": ["bounds.triangles-per-rank=2e3", "decomposition.subdomains-per-rank=10", "cluster.ranks=4",
                        "mapping.method=graph", "run.aggregation=[1, 16, 1024]"],
        "paper/fig-10": ["bounds.triangles-per-rank=300", "decomposition.subdomains-per-rank=2",
                         "cluster.groups=[[{ranks: 2, speed: 1100}], [{ranks: 64, speed: 1100}, {ranks: 16, speed: 920}]]"],
        "paper/fig-11": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "sciclone-144": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "published-pipe": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "published-flow": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "published-chesapeake": ["bounds.triangles-per-rank=300", "decomposition.subdomains=300"],
        "modern-1024": ["bounds.triangles-per-rank=30", "decomposition.subdomains-per-rank=2",
                        "balance.policy=[none, greedy]"],
        "wrong-forecasts": ["repetitions=1", "bounds.triangles=1e5", "decomposition.forecast-error=[1, 16]", "balance.policy=[none, zoltan]"],
        "grand-4096": ["bounds.triangles-per-rank=30", "decomposition.subdomains-per-rank=2",
                       "balance.policy=[none, stealing]"],
        "two-ranks": ["bounds.triangles=2e4"],
        "two-speeds": ["repetitions=1", "bounds.triangles-per-rank=5e3"],
        "corner-refinement": ["sizing.size=\"x < 0.45 && y < 0.45 ? 0.006 : 0.05\"",
                              "decomposition.subdomains-per-rank=10"],
        "policies": ["repetitions=1", "bounds.triangles-per-rank=1e3", "decomposition.subdomains-per-rank=8"],
        "migration-stress": ["bounds.triangles=3e4", "cluster.scale=100", "decomposition.subdomains=[24, 120]",
                             "cluster.groups=[{ranks: 6, speed: 8e4}, {ranks: 6, speed: 1e4}]"],
        "changing-speeds": ["repetitions=1", "bounds.triangles=1e4", "decomposition.subdomains-per-rank=4"],
        "late-hosts": ["repetitions=1", "bounds.triangles=1e4", "decomposition.subdomains-per-rank=4"],
        "short-memory": ["repetitions=1", "bounds.triangles=1e5", "decomposition.subdomains-per-rank=20",
                         "cluster.memory=[0, 21e3]"],
        "balancing/details": ["bounds.triangles=1e4", "decomposition.subdomains-per-rank=8", "mapping.method=graph"],
        "balancing/nothing-to-balance": ["bounds.triangles-per-rank=2e3", "mapping.method=graph"],
        "balancing/slow-network": ["repetitions=1", "bounds.triangles=2e4", "decomposition.subdomains-per-rank=4"],
        "balancing/ten-to-one": ["repetitions=1", "bounds.triangles-per-rank=2e3"],
        "scaled-speedup": ["bounds.triangles-per-rank=3e3", "cluster.ranks=[1, 2, 8]"],
    }

    def run_config(self, name, *settings, folder="results", report=False):
        settings = [*settings, f"report={'true' if report else 'false'}"]
        arguments = [word for setting in settings for word in ("--set", setting)]
        return self.succeed("run", self.CONFIGS / f"{name}.yaml", "-o", folder, *arguments)

    def table(self, folder="results"):
        with open(self.folder / folder / "table.csv", newline="") as file:
            return list(csv.DictReader(file))


class Shipped(RunsOfExperiments):
    """Every shipped experiment at a small size."""

    def test_every_shipped_experiment(self):
        shipped = {path.relative_to(self.CONFIGS).with_suffix("").as_posix() for path in self.CONFIGS.rglob("*.yaml")}
        self.assertEqual(shipped, set(self.SHRUNK))
        for name in sorted(shipped):
            with self.subTest(config=name):
                said = self.run_config(name, *self.SHRUNK[name], folder=name)
                rows = self.table(name)
                self.assertEqual(len(rows) + 2, sum(line.startswith("|") for line in said.splitlines()))
                for number, row in enumerate(rows, 1):
                    record = json.loads((self.folder / name / f"{row['run']}.json").read_text())
                    self.assertEqual(record["mesh"]["triangles"], int(row["triangles"]))
                    self.assertEqual(record["cluster"]["seconds"], float(row["seconds"]))
                    self.assertEqual(len(record["parts"]["ranks"]), int(row["ranks"]))
                    self.assertGreaterEqual(record["mesh"]["smallest_angle"], 20)
                    shares = [float(row[kind]) for kind in ("computing", "sending", "polling", "balancing", "idle")]
                    self.assertAlmostEqual(sum(shares), 1)
                    self.assertTrue(all(0 <= share <= 1 for share in shares), shares)
                    self.assertIn(str(number), row["run"])


class Experiments(RunsOfExperiments):
    """Settings, results and errors of driftmesh run."""

    def test_aggregation_saves_messages(self):
        self.run_config("paper/fig-7", *self.SHRUNK["paper/fig-7"])
        one, some, all_together = self.table()
        self.assertEqual(one["splits"], one["split_messages"])
        self.assertGreater(int(one["split_messages"]), int(some["split_messages"]))
        self.assertGreaterEqual(int(some["split_messages"]), int(all_together["split_messages"]))
        self.assertGreater(float(one["sending"]), float(all_together["sending"]))

    def test_costs_are_measured_and_used(self):
        self.succeed("calibrate", "--quick", "-o", "costs.yaml")
        self.succeed("calibrate", "--quick")
        self.run_config("first-run", *self.SHRUNK["first-run"], "cluster.costs=costs.yaml", folder="measured")
        self.write("costs.yaml", "start: 1\n")
        self.run_config("first-run", *self.SHRUNK["first-run"], "cluster.costs=costs.yaml", folder="slow")
        self.assertGreater(float(self.table("slow")[0]["seconds"]), 1)

    def test_the_complete_experiment_reproduces_itself(self):
        self.run_config("first-run", *self.SHRUNK["first-run"], folder="first")
        self.succeed("run", "first/experiment.yaml", "-o", "again", "--quiet")
        self.assertEqual(self.table("first"), self.table("again"))

    def test_a_complete_experiment_finds_its_input_from_its_folder(self):
        self.succeed("generate", "pipe", "-o", "pipe.poly")
        self.write("small.yaml", "input: {file: pipe.poly}\nbounds: {triangles: 1e4}\ncluster: {ranks: 2}\n")
        self.succeed("run", "small.yaml", "-o", "first/try", "--quiet")
        self.succeed("run", "first/try/experiment.yaml", "-o", "again", "--quiet")
        self.assertEqual(self.table("first/try"), self.table("again"))

    def sweep(self, folder, *options):
        return ["run", "sweep.yaml", "-o", folder, *options]

    def figures(self, folder):
        """All but the time of the processor that cuts the domain."""
        return [{column: value for column, value in row.items() if "cutting" not in column} for row in self.table(folder)]

    def test_what_was_killed_is_resumed(self):
        self.write("sweep.yaml", "input: {generate: pipe}\nbounds: {triangles: 2e4}\ncluster: {ranks: 2}\nrepetitions: 3\n"
                                 "sweep: {run.aggregation: [1, 512], cluster.drag: [[1, 0.5]]}\n")
        self.succeed(*self.sweep("whole", "--quiet"))
        with subprocess.Popen([program.PATH, *self.sweep("killed")], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              env=RANKS_ENVIRONMENT) as run:
            while run.poll() is None and not ((self.folder / "killed/table.csv").exists() and len(self.table("killed")) >= 2):
                time.sleep(0.01)
            run.kill()
        there = {path: path.stat().st_mtime_ns for path in (self.folder / "killed").glob("run-*.json") if path.stem in
                 [row["run"] for row in self.table("killed")]}
        result = self.run_program(*self.sweep("killed", "--resume"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{len(there)} of 6 runs are there", result.stderr)
        self.assertEqual(self.figures("killed"), self.figures("whole"))
        self.assertEqual(there, {path: path.stat().st_mtime_ns for path in there})

    def test_however_much_of_a_table_there_is(self):
        self.write("sweep.yaml", "input: {generate: pipe}\nbounds: {triangles: 5e3}\ncluster: {ranks: 2}\nsweep: {run.aggregation: [1, 8, 512]}\n")
        self.succeed(*self.sweep("whole", "--quiet"))
        whole, path = self.figures("whole"), self.folder / "whole" / "table.csv"
        lines = path.read_text().splitlines(keepends=True)
        for text in ("", lines[0], *("".join(lines[:k]) for k in (2, 3, 4)), "".join(lines)[:-1], "".join(lines)[:-40], lines[0] + lines[2]):
            with self.subTest(text=text):
                path.write_text(text)
                self.succeed(*self.sweep("whole", "--quiet", "--resume"))
                self.assertEqual(self.figures("whole"), whole)
        kept = path.read_text()
        self.refuse(*self.sweep("whole", "--quiet", "--resume", "--set", "bounds.triangles=6e3"), says=["whole/experiment.yaml", "--resume"])
        self.assertEqual(path.read_text(), kept)
        self.succeed(*self.sweep("new", "--quiet", "--resume"))
        self.assertEqual(self.figures("new"), whole)

    def test_a_page_shows_all_runs(self):
        said = self.run_config("scaled-speedup", *self.SHRUNK["scaled-speedup"], "cluster.ranks=[1, 2]", report=True)
        page = self.folder / "results" / "report.html"
        if not re.search(r"^  report ", self.succeed("--help"), re.MULTILINE):  # only if npm was there when it was built
            self.assertFalse(page.exists())
            return
        self.assertIn("results/report.html", said)
        self.assertEqual(re.findall(r'data-run="(.*?)"', page.read_text()), ["run-1", "run-2"])

    def test_moves_are_recorded(self):
        self.run_config("two-speeds", "repetitions=1", "bounds.triangles-per-rank=2e5", "balance.policy=greedy", report=True)
        record = json.loads((self.folder / "results" / "run-1.json").read_text())
        owners, moves = record["cluster"]["owners_before"], record["cluster"]["moves"]
        self.assertGreater(len(moves), 0)
        self.assertEqual(len(moves), int(self.table()[0]["hand_offs"]))
        self.assertEqual(sum(move["bytes"] for move in moves), int(self.table()[0]["hand_off_bytes"]))
        for move in moves:
            self.assertEqual(owners[move["subdomain"]], move["from"])
            self.assertLess(move["left"], move["arrived"])
            owners[move["subdomain"]] = move["to"]
        self.assertEqual(owners, record["cluster"]["owners_after"])
        trace = json.loads((self.folder / "results" / "run-1.trace.json").read_text())["traceEvents"]
        self.assertEqual(sum(event["ph"] == "s" for event in trace), len(moves))
        self.assertEqual(sum(event["ph"] == "f" for event in trace), len(moves))
        self.assertTrue(any(event["ph"] == "i" and event["name"] == "plan: done" for event in trace))
        worked = sum(event["dur"] for event in trace if event["name"] == "refine")
        computing = sum(rank["seconds"]["computing"] for rank in record["parts"]["ranks"])
        self.assertAlmostEqual(worked / 1e6, computing, delta=0.01 * computing)

    def test_ranks_take_no_work_beyond_their_memory(self):
        self.run_config("short-memory", *self.SHRUNK["short-memory"])
        for row in self.table():
            with self.subTest(memory=row["cluster.memory"], policy=row["balance.policy"]):
                record = json.loads((self.folder / "results" / f"{row['run']}.json").read_text())
                most = max(rank["triangles"] for rank in record["parts"]["ranks"])
                if row["balance.policy"] != "none":
                    self.assertGreater(int(row["hand_offs"]), 0)
                    self.assertEqual(most > 21e3, row["cluster.memory"] == "0", most)
        self.refuse("run", self.CONFIGS / "short-memory.yaml", "-o", "none", "--set", "bounds.triangles=1e5", "--quiet",
                    "--set", "cluster.memory=1e4", code=3, says=["cluster.memory"])

    def test_late_ranks_begin_without_work_and_get_some(self):
        self.run_config("late-hosts", "repetitions=1", "bounds.triangles=2e5", "decomposition.subdomains-per-rank=20", "cluster.speed=1e4",
                        "cluster.scale=790")
        rows = self.table()
        for row in rows:
            with self.subTest(policy=row["balance.policy"]):
                record = json.loads((self.folder / "results" / f"{row['run']}.json").read_text())
                self.assertLess(max(record["cluster"]["owners_before"]), 12)
                late = [rank["triangles"] for rank in record["parts"]["ranks"][12:]]
                self.assertEqual(sum(late) > 0, row["balance.policy"] != "none")
                arrived = [move["arrived"] for move in record["cluster"]["moves"] if move["to"] >= 12]
                self.assertEqual(len(arrived) > 0, row["balance.policy"] != "none")
                self.assertGreaterEqual(min(arrived, default=0.5), 0.5)
        none, *others = (float(row["seconds"]) for row in rows)
        self.assertLess(max(others), 0.95 * none)
        self.refuse("run", self.CONFIGS / "late-hosts.yaml", "-o", "none", "--quiet", "--set",
                    "cluster.changes=[{rank: 0, ranks: 16, factor: 0}, {rank: 0, ranks: 16, at: 1}]",
                    says=["mapping.to-late-ranks"])

    def test_a_recorded_run_is_replayed_with_other_policies(self):
        self.run_config("changing-speeds", "repetitions=1", "bounds.triangles=2e5", "decomposition.subdomains-per-rank=20",
                        "cluster.speed=1e4", "cluster.scale=790", "balance.policy=[none, greedy]")
        record = self.folder / "results" / "run-1.json"
        said = self.succeed("replay", record)
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in said.splitlines()]
        self.assertEqual(rows[0], ["policy", "seconds", "efficiency", "regret %", "moved"])
        seconds = {row[0]: float(row[1]) for row in rows[2:]}
        self.assertEqual(list(seconds), ["recorded: none", "none", "zoltan", "diffusion", "stealing", "greedy"])
        none, greedy = (float(row["seconds"]) for row in self.table())
        self.assertAlmostEqual(seconds["recorded: none"], none, delta=1e-3 * none)
        self.assertAlmostEqual(seconds["none"], none, delta=0.05 * none)
        self.assertAlmostEqual(seconds["greedy"], greedy, delta=0.2 * greedy)
        self.assertLess(seconds["greedy"], 0.7 * none)
        again = self.succeed("replay", record, "--policy", "zoltan", "--parameter", "zoltan.method=rcb", "--policy", "none")
        self.assertEqual(len(again.splitlines()), 5)
        self.refuse("replay", record, "--policy", "greed", says=["greed", "greedy"])
        self.refuse("replay", record, "--policy", "greedy", "--parameter", "greedy.tolerance=-1", says=["tolerance"])
        self.refuse("replay", record, "--policy", "greedy", "--parameter", "tolerance", code=2, says=["NAME=VALUE"])

    def test_a_replay_keeps_to_the_memory_of_its_ranks(self):
        self.run_config("short-memory", "repetitions=1", "bounds.triangles=1e5", "decomposition.subdomains-per-rank=20",
                        "cluster.memory=21e3", "balance.policy=[none, greedy, stealing]")
        took = [float(row["seconds"]) for row in self.table()]
        said = self.succeed("replay", self.folder / "results" / "run-1.json", "--policy", "greedy", "--policy", "stealing")
        again = [float(line.split("|")[2]) for line in said.splitlines()[2:]]
        for run, replay in zip(took, again, strict=True):
            self.assertAlmostEqual(replay, run, delta=0.08 * run)

    def test_what_cannot_be_replayed_is_refused(self):
        self.run_config("first-run", *self.SHRUNK["first-run"])
        good = (self.folder / "results" / "run-1.json").read_text()
        (self.folder / "bad.json").write_text(good[:100])
        self.refuse("replay", "bad.json", says=["bad.json", "is not JSON"])
        self.refuse("replay", "missing.json", says=["missing.json"])
        (self.folder / "bad.json").write_text("[1]")
        self.refuse("replay", "bad.json", says=["bad.json", "not the record of an experiment's run"])
        for place, value, words in ((("cluster", "subdomains"), None, "has no /cluster/subdomains"),
                                    (("cluster", "owners_before"), [7] * 1000, "another number of /cluster/subdomains/forecast"),
                                    (("cluster", "speeds"), [0, 0], "ranks without speed"),
                                    (("experiment", "balance.look"), "soon", "another kind of /experiment/balance.look")):
            record = json.loads(good)
            if value is None:
                del record[place[0]][place[1]]
            else:
                record[place[0]][place[1]] = value
            (self.folder / "bad.json").write_text(json.dumps(record))
            self.refuse("replay", "bad.json", says=["bad.json", words])
        for field, value, words in (("neighbors", 99999, "neighbor that is not there"), ("work", -1, "invalid number")):
            record = json.loads(good)
            first = record["cluster"]["subdomains"][field]
            first[0] = [value] * len(first[0]) if field == "neighbors" else value
            (self.folder / "bad.json").write_text(json.dumps(record))
            self.refuse("replay", "bad.json", says=["bad.json", words])

    def test_decisions_explain_each_move(self):
        for policy in ("greedy", "zoltan", "diffusion", "stealing"):
            self.run_config("two-speeds", "repetitions=1", "bounds.triangles-per-rank=5e4", "cluster.scale=20",
                            "cluster.groups=[{ranks: 4, speed: 4e5}, {ranks: 4, speed: 2e5}]", f"balance.policy={policy}", folder=policy)
            record = json.loads((self.folder / policy / "run-1.json").read_text())
            lines = [json.loads(line) for line in (self.folder / policy / "run-1.decisions.jsonl").read_text().splitlines()]
            self.assertEqual([line["time"] for line in lines], sorted(line["time"] for line in lines))
            moved = [line for line in lines if line["what"] == "move"]
            self.assertEqual([(m["subdomain"], m["rank"], m["to"], m["time"], m["arrived"]) for m in moved],
                             [(m["subdomain"], m["from"], m["to"], m["left"], m["arrived"]) for m in record["cluster"]["moves"]])
            self.assertGreater(len(moved), 0)
            planned = set()  # what plans that were made wanted to move
            for line in lines:
                if line["what"] == "plan" and line["verdict"] == "done":
                    planned |= {(m["subdomain"], m["from"], m["to"]) for m in line["moves"] if m["verdict"] == "done"}
                elif line["what"] == "advice":
                    for m in line["moves"]:
                        self.assertIn((m["subdomain"], m["from"], m["to"]), planned)
                elif line["what"] == "move":
                    self.assertIn((line["subdomain"], line["rank"], line["to"]), planned)
                elif line["what"] == "load":
                    self.assertGreaterEqual(line["finish"], line["ideal"])
                elif line["what"] == "request" and line["verdict"] == "done":
                    self.assertNotEqual(line["thief"], line["giver"])

    def run_on_ranks(self, ranks, *settings, folder="results"):
        arguments = [word for setting in ("cluster.kind=real", *settings) for word in ("--set", setting)]
        result = self.on_ranks(ranks, "run", self.CONFIGS / "two-ranks.yaml", "-o", folder, *arguments)
        self.assertEqual((result.returncode, without_progress(result.stderr)), (0, ""), result.stderr)
        return result.stdout

    def test_partially_coupled_refinement_is_the_same_on_real_and_on_simulated_ranks(self):
        self.write("methods.yaml", "input: {generate: pipe}\nbounds: {triangles: 5e4}\nsweep: {run.method: [coupled, pdr]}\n")
        for ranks in 1, 2, 4:
            result = self.on_ranks(ranks, "run", "methods.yaml", "-o", "real", "--set", "cluster.kind=real")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.succeed("run", "methods.yaml", "-o", "simulated", "--set", f"cluster.ranks={ranks}")
            for run in "run-1", "run-2":
                real, simulated = (json.loads((self.folder / folder / f"{run}.json").read_text()) for folder in ("real", "simulated"))
                self.assertEqual(real["mesh"], simulated["mesh"], f"{run} on {ranks}")
                self.assertEqual(sum(r["triangles"] for r in real["parts"]["ranks"]), real["mesh"]["triangles"])
            self.assertEqual(sum(r["splits_sent"] for r in real["parts"]["ranks"]) > 0, ranks > 1)
        for settings, says in ((["sizing.size=0.1", "bounds.triangles=0"], "run.method"), (["run.threads=2"], "run.threads"),
                               (["decomposition.subdomains=8"], "run.method"), (["balance.policy=greedy"], "balance.policy"),
                               (["limits.max-triangles=1000"], "limits.max-triangles")):
            with self.subTest(settings=settings):
                words = [word for setting in ("cluster.kind=real", *settings) for word in ("--set", setting)]
                refused = self.on_ranks(2, "run", "methods.yaml", "-o", "refused", *words)
                self.assertNotEqual(refused.returncode, 0)
                self.assertIn(says, refused.stderr)
        self.refuse("run", "methods.yaml", "--dry-run", "--set", "cluster.ranks=2", "--set", "bounds.triangles=0",
                    says=["run.method", "nothing bounds the size"])

    def test_real_ranks_make_the_same_files_and_the_same_mesh(self):
        settings = ["bounds.triangles=2e5", "decomposition.subdomains=60", "cluster.drag=[1, 0.05]", "lb-statistics=2"]
        said = self.run_on_ranks(2, *settings, folder="real")
        self.run_config("two-ranks", *settings, report=True, folder="simulated")
        rows = self.table("real")
        self.assertEqual([row["balance.policy"] for row in rows], ["none", "stealing", "zoltan"])
        self.assertEqual(list(rows[0]), list(self.table("simulated")[0]))
        self.assertEqual(said.count("\n|"), len(rows) + 1)
        files = [{str(path.relative_to(self.folder / folder)) for path in (self.folder / folder).rglob("*")}
                 for folder in ("real", "simulated")]
        self.assertEqual(*files)
        for row in rows:
            record, simulated = (json.loads((self.folder / folder / f"{row['run']}.json").read_text())
                                 for folder in ("real", "simulated"))
            self.assertEqual(record["mesh"]["digest"], simulated["mesh"]["digest"])
            self.assertEqual(record["mesh"]["vertices"], simulated["mesh"]["vertices"])
            self.assertEqual(list(record["cluster"]), list(simulated["cluster"]))
            ranks, cluster = record["parts"]["ranks"], record["cluster"]
            self.assertEqual(len(ranks), 2)
            self.assertEqual(sum(rank["triangles"] for rank in ranks), record["mesh"]["triangles"])
            self.assertEqual(float(row["seconds"]), cluster["seconds"])
            self.assertGreaterEqual(cluster["seconds"], max(rank["seconds"]["computing"] for rank in ranks))
            owners = cluster["owners_before"]
            for move in cluster["moves"]:
                self.assertEqual(owners[move["subdomain"]], move["from"])
                self.assertLess(move["left"], move["arrived"])
                owners[move["subdomain"]] = move["to"]
            self.assertEqual(owners, cluster["owners_after"])
        # A rank that works a twentieth of its time makes less than a million triangles per second, whatever the load.
        record = json.loads((self.folder / "real" / "run-1.json").read_text())
        self.assertAlmostEqual(record["cluster"]["speeds"][0], 20 * record["cluster"]["speeds"][1], delta=1)
        dragged = record["parts"]["ranks"][1]
        self.assertLess(dragged["triangles"] / dragged["seconds"]["computing"], 1e6)

    def test_one_process_is_a_real_cluster_too(self):
        self.run_config("two-ranks", "cluster.kind=real", "cluster.ranks=0", "cluster.drag=[]", "bounds.triangles=2e4",
                        "balance.policy=none")
        self.assertEqual(self.table()[0]["ranks"], "1")
        self.assertEqual(self.table()[0]["messages"], "0")

    def test_zoltan_may_have_started_mpi_before(self):
        # Its parameters are checked when the experiment is read.
        self.run_config("two-ranks", "cluster.kind=real", "cluster.ranks=0", "cluster.drag=[]", "bounds.triangles=2e4",
                        "balance.policy=zoltan", "balance.parameters={IMBALANCE_TOL: '1.1'}")
        self.assertEqual(self.table()[0]["ranks"], "1")

    def test_a_name_that_is_no_text(self):
        name = os.fsdecode(b"b\xff.poly")
        self.write(name, SQUARE)
        self.write("odd.yaml", os.fsencode(f"input: {{file: {name}}}\nbounds: {{triangles: 2e3}}\ncluster: {{ranks: 2}}\n"
                                           "report: false\nlb-statistics: 2\n"))
        self.succeed("run", "odd.yaml", "-o", "results")
        self.assertEqual(json.loads((self.folder / "results/run-1.json").read_text())["parts"]["subdomains"], 40)

    def test_subdomains_beyond_all_bounds_are_refused(self):
        config = self.write("many.yaml", "input: {generate: pipe}\nbounds: {triangles: 2e4}\ncluster: {ranks: 50000}\n"
                            "decomposition: {subdomains-per-rank: 50000}\n")
        self.refuse("run", config, says=["from 1 to 10000000, not 2147483647"])

    def test_settings_that_do_not_fit_the_ranks_are_reported_once_with_their_place(self):
        config = self.write("both.yaml", "input: {generate: pipe}\nbounds: {triangles: 2e4}\ncluster:\n  kind: simulated\n"
                            "  ranks: 3\n  drag: [1, 1, 0.5]\n")
        real = ["--set", "cluster.kind=real"]
        for settings, place, message in (
                ([], "both.yaml:4:9:", "is simulated, which takes one process, but mpirun has started 2"),
                (real, "both.yaml:5:10:", "is 3, but mpirun has started 2 processes"),
                ([*real, "--set", "cluster.ranks=0"], "both.yaml:6:9:", "has 3 values for 2 ranks"),
                ([*real, "--set", "cluster.speed=1e6"], "--set cluster.speed=1e6", "applies only to simulated clusters"),
                (["--set", "sizing.background=missing"], "missing", "")):
            if settings[-1:] == ["sizing.background=missing"]:
                settings = [*real, "--set", "cluster.ranks=2", "--set", "cluster.drag=[]", *settings]
            result = self.on_ranks(2, "run", config, *settings)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertEqual(result.stderr.count("driftmesh: "), 1, result.stderr)
            self.assertIn(place, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertEqual(result.stdout, "")
        self.refuse("run", config, *real, says=["both.yaml:5:10:", "mpirun -n 3"])
        self.refuse("run", config, "--set", "cluster.drag=[1, 0.5]", says=["'cluster.drag'", "one for each rank"])
        self.refuse("run", config, "--set", "cluster.drag=[1, 2, 0.5]", says=["is 2", "at most 1"])
        missing = self.on_ranks(2, "run", "missing.yaml")
        self.assertEqual((missing.returncode, missing.stderr.count("driftmesh: ")), (1, 1), missing.stderr)

    def test_drag_is_a_lower_speed_in_simulation(self):
        self.run_config("two-ranks", "bounds.triangles=2e4", "balance.policy=none", folder="dragged")
        self.run_config("two-ranks", "bounds.triangles=2e4", "balance.policy=none", "cluster.ranks=0", "cluster.drag=[]",
                        "cluster.groups=[{ranks: 1, speed: 2e6}, {ranks: 1, speed: 1e6}]", folder="slow")
        self.run_config("two-ranks", "bounds.triangles=2e4", "balance.policy=none", "cluster.speed=2e6", folder="both")
        speeds = [json.loads((self.folder / folder / "run-1.json").read_text())["cluster"]["speeds"]
                  for folder in ("dragged", "slow", "both")]
        self.assertEqual(speeds[0][0], 2 * speeds[0][1])
        self.assertEqual(speeds[1], speeds[2])
        self.assertEqual(self.table("slow")[0]["seconds"], self.table("both")[0]["seconds"])

    def test_the_table_shows_what_each_policy_recovers(self):
        said = self.run_config("two-ranks", "bounds.triangles=2e5", "decomposition.subdomains=60",
                               "decomposition.skew=[0, 0.5]", "balance.policy=[stealing, none]")
        self.assertIn("recovered %", said)
        for skew in 0, 2:
            stealing, none = self.table()[skew:skew + 2]
            self.assertEqual(none["recovered"], "")
            possible = float(none["seconds"]) - float(none["ideal_seconds"])
            self.assertAlmostEqual(float(stealing["recovered"]) * possible,
                                   float(none["seconds"]) - float(stealing["seconds"]))
            self.assertGreater(float(stealing["recovered"]), 0.5)
        self.assertNotIn("recovered", self.run_config("first-run", *self.SHRUNK["first-run"]))

    def test_a_rerun_leaves_nothing_of_an_earlier_one(self):
        self.run_config("first-run", *self.SHRUNK["first-run"], "repetitions=3", report=True)
        folder = self.folder / "results"
        (folder / "notes.txt").write_text("mine")
        (folder / "run-1.txt").write_text("mine")
        self.assertTrue((folder / "run-3.trace.json").exists())
        self.run_config("first-run", *self.SHRUNK["first-run"])
        self.assertEqual({path.name for path in folder.iterdir()},
                         {"experiment.yaml", "table.csv", "run-1.json", "run-1.decisions.jsonl", "notes.txt", "run-1.txt"})
        (folder / "experiment.yaml").unlink()
        (folder / "run-7.json").write_text("{}")  # of somebody else
        self.run_config("first-run", *self.SHRUNK["first-run"])
        self.assertTrue((folder / "run-7.json").exists())

    def test_the_stress_moves_subdomains_that_are_being_refined(self):
        self.run_config("migration-stress", *self.SHRUNK["migration-stress"], "decomposition.subdomains=24",
                        "balance.policy=[zoltan, greedy]")
        for run in 1, 2:
            record = json.loads((self.folder / "results" / f"run-{run}.json").read_text())
            moved = [move["bytes"] for move in record["cluster"]["moves"]]
            begun = [size for size in moved if size > 2000]  # without triangles, it is some hundred bytes
            self.assertGreater(len(moved), 10)
            self.assertGreater(len(begun), len(moved) / 3)

    def test_statistics_for_load_balancing_research(self):
        phases = 4
        self.run_config("migration-stress", "balance.policy=stealing", "decomposition.subdomains=1200",
                        f"lb-statistics={phases}")
        record = json.loads((self.folder / "results" / "run-1.json").read_text())
        ranks, subdomains = record["parts"]["ranks"], record["parts"]["subdomains"]
        self.assertGreater(len(record["cluster"]["moves"]), 0)
        folder = self.folder / "results" / "run-1.lb-stats"
        self.assertEqual({path.name for path in folder.iterdir()}, {f"data.{r}.json" for r in range(len(ranks))})
        files = [json.loads((folder / f"data.{r}.json").read_text()) for r in range(len(ranks))]
        said = 0
        for rank, file in enumerate(files):
            self.assertEqual((file["metadata"]["type"], file["metadata"]["rank"]), ("LBDatafile", rank))
            self.assertEqual([phase["id"] for phase in file["phases"]], list(range(phases)))
            for phase in file["phases"]:
                self.check_lb_phase(phase, rank)
                self.assertLessEqual(sum(task["time"] for task in phase["tasks"]),
                                     record["cluster"]["seconds"] / phases * (1 + 1e-9))
                said += sum(edge["messages"] for edge in phase["communications"])
            worked = sum(task["time"] for phase in file["phases"] for task in phase["tasks"])
            # Work outside of slices, such as recording points, counts only as computing.
            self.assertAlmostEqual(worked, ranks[rank]["seconds"]["computing"], delta=1e-9 + 1e-3 * worked)
        self.assertEqual(said, sum(rank["interface_splits"] for rank in ranks))
        for number in range(phases):  # each subdomain is one task, wherever it is
            movable = [task["entity"]["index"] for file in files for task in file["phases"][number]["tasks"]
                       if task["entity"]["migratable"]]
            self.assertEqual(sorted(movable), [[s] for s in range(subdomains)])
            ids = [task["entity"]["id"] for file in files for task in file["phases"][number]["tasks"]]
            self.assertEqual(len(ids), len(set(ids)))

    def test_a_mapping_comes_from_statistics_that_others_changed(self):
        settings = ["bounds.triangles=3e3", "decomposition.subdomains=40", "cluster.ranks=3", "balance.policy=none"]
        self.run_config("first-run", *settings, "lb-statistics=2", folder="before")
        owners = {}
        files = [json.loads((self.folder / "before" / "run-1.lb-stats" / f"data.{rank}.json").read_text()) for rank in range(3)]
        (self.folder / "after").mkdir()
        for with_index in True, False:
            for rank, file in enumerate(files):
                for task in file["phases"][-1]["tasks"]:
                    if not task["entity"]["migratable"]:
                        continue
                    number = (task["entity"]["id"] >> 18) - 1
                    task["node"] = owners[number] = number * 7 % 3
                    if not with_index:
                        task["entity"].pop("index", None)
                (self.folder / "after" / f"data.{rank}.json").write_text(json.dumps(file))
            name = f"mapped-{with_index}"
            self.run_config("first-run", *settings, "mapping.file=after/data.0.json", folder=name)
            record = json.loads((self.folder / name / "run-1.json").read_text())
            self.assertEqual(record["cluster"]["owners_before"], [owners[s] for s in range(40)])
        config = self.CONFIGS / "first-run.yaml"
        refused = lambda *more, says: self.refuse("run", config, "-o", "x", "--set", "mapping.file=after/data.0.json",
                                                  *(word for setting in [*settings, *more] for word in ("--set", setting)),
                                                  says=says)
        refused("decomposition.subdomains=41", says=["maps no rank to subdomain 40"])
        refused("decomposition.subdomains=39", says=["names subdomain 39, but there are 39"])
        refused("cluster.ranks=2", says=["names rank 2, but there are 2"])
        refused("mapping.method=block", says=["mapping.file", "replaces the mapping"])
        (self.folder / "after" / "data.1.json").write_text('{"phases": [{"id": 0, "tasks": [{}]}]}')
        refused(says=["data.1.json: has a task without an entity"])
        (self.folder / "after" / "data.1.json").write_text("{")
        refused(says=["data.1.json: has no phases"])
        shutil.copy(self.folder / "after" / "data.0.json", self.folder / "after" / "data.1.json")
        refused(says=["twice"])

    def check_lb_entity(self, entity):
        known = {"collection_id", "home", "id", "index", "migratable", "type", "objgroup_id", "seq_id"}
        self.assertLessEqual(set(entity), known)
        self.assertEqual(entity["type"], "object")
        self.assertIs(type(entity["id"]), int)
        self.assertIs(type(entity["migratable"]), bool)
        self.assertEqual(entity["id"] >> 2 & 0xffff, entity["home"])  # as vt's own numbers say it
        self.assertEqual(entity["id"] & 3, 3 if entity["migratable"] else 1)
        if entity["migratable"]:
            self.assertIs(type(entity["collection_id"]), int)

    def check_lb_phase(self, phase, rank):
        """The structure that vt's validator requires: these fields, of these types."""
        self.assertEqual(set(phase), {"id", "tasks", "communications"})
        for task in phase["tasks"]:
            self.assertLessEqual(set(task), {"attributes", "entity", "node", "resource", "subphases", "time"})
            self.assertEqual((task["node"], task["resource"], type(task["time"])), (rank, "cpu", float))
            self.check_lb_entity(task["entity"])
        for edge in phase["communications"]:
            self.assertEqual(set(edge), {"type", "from", "to", "messages", "bytes"})
            self.assertEqual((edge["type"], type(edge["messages"]), type(edge["bytes"])), ("SendRecv", int, float))
            self.check_lb_entity(edge["from"])
            self.check_lb_entity(edge["to"])

    def test_a_dry_run_prints_and_does_nothing(self):
        said = self.succeed("run", self.CONFIGS / "scaled-speedup.yaml", "--dry-run")
        self.assertIn("triangles-per-rank: 25000", said)
        self.assertIn("# 13 runs", said)
        self.assertEqual(self.files(), [])

    def test_errors_are_reported_before_anything_runs(self):
        self.write("wrong.yaml", "input: {generate: pipe}\nclutser: {ranks: 2}\n")
        self.refuse("run", "wrong.yaml", says=["wrong.yaml:2:1", "'cluster"])
        self.refuse("run", "missing.yaml", says=["missing.yaml"])
        self.refuse("run", self.CONFIGS / "first-run.yaml", "--set", "bounds.angle=50", says=["at most 34"])
        self.refuse("run", self.CONFIGS / "policies.yaml", "--set", "balance.parameters={methd: rcb}", says=["methd"])
        self.refuse("config", code=2)
        self.assertEqual(self.files(), ["wrong.yaml"])

    def test_the_schema_is_valid(self):
        schema = json.loads(self.succeed("config", "--schema"))
        self.assertEqual(schema["properties"]["run"]["properties"]["order"]["enum"], ["given", "largest", "backlog"])
        self.assertIn("| `bounds.angle` |", self.succeed("config", "--keys"))
        self.assertIn("| `hypot(a, b)` |", self.succeed("config", "--functions"))


if __name__ == "__main__":
    main()

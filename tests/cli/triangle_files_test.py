#!/usr/bin/env python3
"""The command triangle: the files that each switch writes for each kind of input, by the formats that Triangle documents, and beside
Triangle's own program where there is one.

usage: triangle_files_test.py DRIFTMESH [unittest options]
"""

import os
import shutil
import subprocess
import unittest

import program
from program import Cli, main

SQUARE = "8 2 1 1\n1 0 0 1 0\n2 4 0 2 0\n3 4 4 3 7\n4 0 4 4 0\n5 1 1 0 0\n6 2 1 0 0\n7 2 2 0 0\n8 1 2 0 0\n"
SEGMENTS = "8 1\n1 1 2 5\n2 2 3 6\n3 3 4 0\n4 4 1 8\n5 5 6 0\n6 6 7 0\n7 7 8 0\n8 8 5 0\n"


def from_zero(text, columns_of_points):
    """The same rows, numbered from 0. `columns_of_points`: which columns are numbers of points."""
    header, *rows = text.splitlines()
    fields = [row.split() for row in rows]
    for row in fields:
        for column in (0, *columns_of_points):
            row[column] = str(int(row[column]) - 1)
    return "\n".join([header, *map(" ".join, fields)]) + "\n"


# Inputs by their files and the first argument. Each can be meshed without -p and, where it has a .poly, with it.
INPUTS = {
    "hole": ({"a.poly": SQUARE + SEGMENTS + "1\n1 1.5 1.5\n0\n"}, "a.poly"),
    "regions": ({"a.poly": SQUARE + SEGMENTS + "0\n2\n1 0.5 0.5 3 0.5\n2 1.5 1.5 4 0.05\n"}, "a.poly"),
    "from zero": ({"a.poly": from_zero(SQUARE, ()) + from_zero(SEGMENTS, (1, 2)) + "1\n0 1.5 1.5\n0\n"}, "a.poly"),
    "beside a .node": ({"a.node": SQUARE, "a.poly": "0 2 1 1\n" + SEGMENTS + "0\n0\n"}, "a.poly"),
    "points": ({"a.node": "5 2 0 0\n0 0 0\n1 3 0\n2 3 3\n3 0 3\n4 1 1.5\n"}, "a.node"),
    "mesh": ({"a.1.node": SQUARE, "a.1.ele": "4 3 1\n1 1 2 6 7\n2 2 3 6 8\n3 6 3 7 9\n4 1 6 5 9\n",
              "a.1.poly": "0 2 1 1\n4 1\n1 1 2 5\n2 2 3 6\n3 5 6 7\n4 6 7 7\n0\n", "a.1.area": "4\n1 -1\n2 0.1\n3 0.2\n4 -1\n"}, "a.1"),
}

# Without the first switch that each input needs.
SWITCHES = ["", "e", "n", "v", "ev", "nev", "q", "q30", "q30a0.1", "a0.5", "qa", "A", "Aa", "D", "qD", "c", "j", "o2", "o2e", "Y", "qYY",
            "S3q", "B", "Be", "P", "N", "E", "O", "g", "C", "q25.5a.3AejnV", "i", "F", "l", "X", "z", "s"]


def table(path, header_length, width):
    """The header of a file, and its rows, of which `width` tells how many fields each has."""
    lines = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    lines = [line for line in lines if line]
    header = [int(field) for field in lines[0]]
    assert len(header) == header_length, (path, header)
    rows = lines[1:1 + header[0]]
    assert len(rows) == header[0], path
    for row in rows:
        assert len(row) == width(header, row), (path, row)
    return header, rows, lines[1 + header[0]:]


class Files:
    """All files of a mesh, each as its format says."""

    def __init__(self, folder, stem):
        self.kinds = sorted(path.name[len(stem) + 1:] for path in folder.iterdir() if path.name.startswith(stem + "."))
        self.headers, self.rows = {}, {}

        def read(kind, header_length, width):
            if kind in self.kinds:
                self.headers[kind], self.rows[kind], rest = table(folder / f"{stem}.{kind}", header_length, width)
                return rest
            return []

        read("node", 4, lambda header, row: 3 + header[2] + header[3])
        read("ele", 3, lambda header, row: 1 + header[1] + header[2])
        read("edge", 2, lambda header, row: 3 + header[1])
        read("neigh", 2, lambda header, row: 4)
        read("v.node", 4, lambda header, row: 3 + header[2])
        read("v.edge", 2, lambda header, row: 5 if row[2] == "-1" else 3)
        if "poly" in self.kinds:
            rest = read("poly", 4, lambda header, row: 0)
            segments, marked = map(int, rest.pop(0))
            self.rows["poly"] = [rest.pop(0) for _ in range(segments)]
            assert all(len(row) == 3 + marked for row in self.rows["poly"])
            self.headers["poly"] += [marked]
            holes = int(rest.pop(0)[0])
            assert all(len(rest.pop(0)) == 3 for _ in range(holes))
            if rest:
                regions = int(rest.pop(0)[0])
                assert all(len(rest.pop(0)) in (4, 5) for _ in range(regions))
            assert not rest

    def structure(self):
        """What does not depend on where points are put: which files there are, their columns, and their first numbers."""
        kinds = [kind for kind in self.kinds if kind != "off"]
        return {kind: (self.headers[kind][0 if kind == "poly" else 1:], self.rows[kind][0][0] if self.rows[kind] else None)
                for kind in kinds}

    def sizes(self):
        """How many of each kind there are, which points, segments and areas alone decide where none are added."""
        return {kind: len(rows) for kind, rows in self.rows.items()}

    def given(self, points, markers):
        """What is as given where no point is added: the first points, with their markers if these are asked for, and segments with theirs."""
        columns = None if markers else -1
        segments = [[*sorted(row[1:3]), row[3]] for kind in ("poly", "edge") for row in self.rows.get(kind, []) if row[3:] not in ([], ["0"])]
        return [[float(field) for field in row[:columns]] for row in self.rows.get("node", [])[:points]], sorted(segments)

    def judge(self, test):
        first = next((int(rows[0][0]) for rows in self.rows.values() if rows), 1)
        for rows in self.rows.values():
            test.assertEqual([int(row[0]) for row in rows], list(range(first, first + len(rows))))
        triangles = {kind: len(self.rows[kind]) for kind in ("ele", "neigh", "v.node") if kind in self.rows}
        test.assertLessEqual(len(set(triangles.values())), 1, triangles)
        edges = {kind: len(self.rows[kind]) for kind in ("edge", "v.edge") if kind in self.rows}
        test.assertLessEqual(len(set(edges.values())), 1, edges)
        if "node" in self.rows:
            points = range(first, first + len(self.rows["node"]))
            corners = self.headers.get("ele", [0, 3])[1]
            named = [int(field) for row in self.rows.get("ele", []) for field in row[1:1 + corners]]
            named += [int(field) for kind in ("edge", "poly") for row in self.rows.get(kind, []) for field in row[1:3]]
            test.assertTrue(all(number in points for number in named))
        if "neigh" in self.rows:
            of = {int(row[0]): [int(field) for field in row[1:]] for row in self.rows["neigh"]}
            test.assertTrue(all(other == -1 or t in of[other] for t, others in of.items() for other in others))


def arguments(files, name, switches):
    own = ("rp" if "a.1.ele" in files else "p" if name.endswith(".poly") else "")
    return ["-" + (own + switches if own + switches else "Q"), name]


class Structure(Cli):
    def make(self, files, folder):
        folder.mkdir()
        for name, text in files.items():
            (folder / name).write_text(text)

    def test_documented_formats(self):
        for label, (files, name) in INPUTS.items():
            for i, switches in enumerate(SWITCHES):
                if "a" in switches.replace("a0", "").replace("a.", "") and label == "points":
                    continue  # it has no areas
                with self.subTest(input=label, switches=switches):
                    folder = self.folder / f"{label} {i}"
                    self.make(files, folder)
                    result = subprocess.run([program.PATH, "triangle", *arguments(files, name, switches)], cwd=folder, text=True,
                                            capture_output=True, check=False, timeout=60)
                    self.assertEqual(result.returncode, 0, result.stderr)
                    stem = "a.2" if label == "mesh" else "a.1"
                    made = Files(folder, stem)
                    made.judge(self)
                    wanted = {"node", "ele"} if label == "points" and "c" not in switches else {"node", "ele", "poly"}
                    wanted -= {kind for switch, kind in (("N", "node"), ("E", "ele"), ("P", "poly")) if switch in switches}
                    wanted |= {kind for switch, kind in (("e", "edge"), ("n", "neigh"), ("v", "v.node"), ("v", "v.edge"), ("g", "off"))
                               if switch in switches}
                    self.assertEqual(set(made.kinds), wanted)
                    if "node" in made.rows:
                        self.assertEqual(made.headers["node"][3], 0 if "B" in switches else 1)
                        self.assertEqual(made.rows["node"][0][0], "0" if label in ("from zero", "points") else "1")
                    if "ele" in made.headers:
                        self.assertEqual(made.headers["ele"][1], 6 if "o2" in switches else 3)
                        with_regions = "A" in switches and label == "regions" or label == "mesh"
                        self.assertEqual(made.headers["ele"][2], 1 if with_regions else 0)
                    for path in files:
                        self.assertEqual((folder / path).read_text(), files[path])
                    says = result.stdout
                    self.assertTrue(says == "" if "Q" in switches else "Writing" in says or not wanted or label == "points", says)

    @unittest.skipUnless(shutil.which("triangle"), "skipped: needs triangle")
    def test_beside_triangle(self):
        for label, (files, name) in INPUTS.items():
            for i, switches in enumerate(SWITCHES):
                if "a" in switches.replace("a0", "").replace("a.", "") and label == "points":
                    continue
                with self.subTest(input=label, switches=switches):
                    made = []
                    for j, command in enumerate(([shutil.which("triangle")], [program.PATH, "triangle"])):
                        folder = self.folder / f"{label} {i} {j}"
                        self.make(files, folder)
                        subprocess.run([*command, *arguments(files, name, switches)], cwd=folder, check=True, timeout=60,
                                       capture_output=True)
                        made.append(Files(folder, "a.2" if label == "mesh" else "a.1"))
                    self.assertEqual(*(files.structure() for files in made))
                    if set(switches) & set("qaDsS") or (label, switches) == ("mesh", "j"):
                        continue  # with points added; or points that an old mesh does not use, which Triangle keeps
                    self.assertEqual(*(files.sizes() for files in made))
                    points = next(int(text.split()[0]) for path, text in sorted(files.items()) if path.endswith((".node", ".poly")))
                    # Points of an old mesh without markers get 1 from Triangle, and those of their segments here.
                    self.assertEqual(*(files.given(points, "B" not in switches and label != "mesh") for files in made))


class Command(Cli):
    def test_under_its_own_name(self):
        os.symlink(program.PATH, self.folder / "triangle")
        self.write("a.poly", INPUTS["hole"][0]["a.poly"])
        result = subprocess.run(["./triangle", "-p", "-q30", "-a0.1ejn", "a"], cwd=self.folder, capture_output=True, text=True, check=True,
                                timeout=60)
        self.assertIn("Mesh triangles", result.stdout)
        self.assertEqual(self.files(), ["a.1.edge", "a.1.ele", "a.1.neigh", "a.1.node", "a.1.poly", "a.poly", "triangle"])

    def test_meshes_are_right(self):
        marked = SEGMENTS.replace(" 0\n", " 1\n")  # on the boundary, 0 becomes 1
        self.write("a.poly", SQUARE + marked + "1\n1 1.5 1.5\n")
        self.succeed("triangle", "-pq30a0.1e", "a.poly")
        self.succeed("check", "a.1.ele", "a.poly", "--angle", "30", "--area", "0.1")
        self.succeed("triangle", "-rpq30a0.02", "a.1")
        self.succeed("check", "a.2.ele", "a.poly", "--angle", "30", "--area", "0.02")
        coarse, fine = (Files(self.folder, stem).rows["node"] for stem in ("a.1", "a.2"))
        self.assertEqual([row[1:] for row in fine[:len(coarse)]], [row[1:] for row in coarse])
        self.write("a.2.area", "".join(f"{i} {value}\n" for i, value in [(len(Files(self.folder, "a.2").rows["ele"]), "")] +
                                       [(t + 1, 0.001 if t < 5 else -1) for t in range(len(Files(self.folder, "a.2").rows["ele"]))]))
        self.succeed("triangle", "-rpqa", "a.2")
        self.assertGreater(len(Files(self.folder, "a.3").rows["ele"]), len(Files(self.folder, "a.2").rows["ele"]))
        self.succeed("check", "a.3.ele", "a.poly")

    def test_markers_and_attributes(self):
        self.write("a.poly", INPUTS["hole"][0]["a.poly"])
        self.succeed("triangle", "-pq30a0.1e", "a.poly")
        made = Files(self.folder, "a.1")
        nodes = {row[0]: (float(row[1]), float(row[2]), float(row[3]), int(row[4])) for row in made.rows["node"]}
        for x, y, attribute, marker in nodes.values():
            inside = 0 < x < 4 and 0 < y < 4
            on_hole = inside and (x in (1, 2) and 1 <= y <= 2 or y in (1, 2) and 1 <= x <= 2)
            if not inside and 0 < x < 4 or not inside and 0 < y < 4:
                self.assertEqual(marker, 5 if y == 0 else 6 if x == 4 else 1 if y == 4 else 8)
            else:
                self.assertEqual(marker > 0, not inside or on_hole)
        self.assertEqual(nodes["3"][3], 7)
        self.assertEqual({row[3] for row in made.rows["edge"]}, {"0", "1", "5", "6", "8"})

    def test_iterations(self):
        self.write("a.poly", INPUTS["hole"][0]["a.poly"])
        self.succeed("triangle", "-pI", "a.poly")
        self.assertEqual(self.files(), ["a.ele", "a.node", "a.poly"])
        self.succeed("triangle", "-pq", "a")
        self.assertEqual(self.files(), ["a.1.ele", "a.1.node", "a.1.poly", "a.ele", "a.node", "a.poly"])
        self.refuse("triangle", "-rI", "a", says=["switch I"])
        self.write("b.node", INPUTS["points"][0]["a.node"])
        self.succeed("triangle", "-I", "b")
        self.assertEqual((self.folder / "b.node").read_text(), INPUTS["points"][0]["a.node"])
        # Vertices in the .node beside a .poly stay there; a .node that nothing was read from is written anew.
        head, rest = program.SQUARE.split("4 1\n")
        self.write("c.node", head)
        self.write("c.poly", "0 2 0 0\n4 1\n" + rest)
        self.succeed("triangle", "-pqa0.5I", "c.poly")
        self.assertEqual((self.folder / "c.node").read_text(), head)
        self.write("d.poly", program.SQUARE)
        self.succeed("triangle", "-pI", "d.poly")
        points = lambda: int((self.folder / "d.node").read_text().split()[0])  # noqa: E731
        few = points()
        self.succeed("triangle", "-pqa0.5I", "d.poly")
        self.assertGreater(points(), few)

    def test_sizes(self):
        self.write("a.poly", INPUTS["hole"][0]["a.poly"])
        self.succeed("triangle", "-pqu", "--size", "0.1 + 0.2 * x", "a.poly")
        self.assertGreater(len(Files(self.folder, "a.1").rows["ele"]), 100)
        self.refuse("triangle", "-pqu", "a.poly", code=2, says=["-u needs", "--size"])
        self.refuse("triangle", "-pq", "--size", "1", "a.poly", code=2, says=["-u"])
        self.refuse("triangle", "-pqu", "--size", "1 +", "a.poly", says=["size expression"])

    def test_limited_points(self):
        self.write("a.poly", INPUTS["hole"][0]["a.poly"])
        for most in (0, 1, 7, 50):
            self.succeed("triangle", f"-pq30a0.01S{most}Q", "a.poly")
            self.assertEqual(len(Files(self.folder, "a.1").rows["node"]), 8 + most)

    def test_errors(self):
        self.write("a.poly", program.SQUARE)
        self.refuse("triangle", "-pk", "a.poly", says=["switch k", "'-pk'"])
        self.refuse("triangle", "-pq50", "a.poly", says=["switch q", "34"])
        self.refuse("triangle", "-p", "b.poly", says=["b.poly"])
        self.refuse("triangle", "-r", "a", says=["a.node"])
        self.refuse("triangle", "-p", code=2, says=["FILE"])
        self.refuse("triangle", "-p", "--angle", "3", "a.poly", code=2, says=["--angle"])
        self.write("c.poly", program.SQUARE.replace("4 4 1 4", "4 4 9 4"))
        self.refuse("triangle", "-p", "c.poly", says=["c.poly:"])
        self.assertEqual(self.files(), ["a.poly", "c.poly"])

    def test_help(self):
        self.assertIn("-o2", self.succeed("triangle", "-h"))
        self.assertEqual(self.succeed("triangle", "-h"), self.succeed("triangle", "--help"))


if __name__ == "__main__":
    main()

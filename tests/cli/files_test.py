#!/usr/bin/env python3
"""The files of a run: nothing that is read is written over, and outputs appear together or not at all.

usage: files_test.py DRIFTMESH [unittest options]
"""

import os

import program
from program import SQUARE, Cli, main

# A background mesh of the square: two triangles, with a length at each point.
BACKGROUND_NODES = "4 2 1 0\n1 0 0 1\n2 4 0 1\n3 4 4 1\n4 0 4 1\n"
BACKGROUND_TRIANGLES = "2 3 0\n1 1 2 3\n2 1 3 4\n"


class Files(Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", SQUARE)

    def contents(self):
        return {str(path.relative_to(self.folder)): path.read_bytes()
                for path in sorted(self.folder.rglob("*")) if path.is_file()}

    def refuse_and_touch_nothing(self, *arguments, says):
        before = self.contents()
        self.refuse(*arguments, says=says)
        self.assertEqual(self.contents(), before)


class NothingReadIsOverwritten(Files):
    def background(self, stem="bg", area=False):
        self.write(f"{stem}.node", BACKGROUND_NODES)
        self.write(f"{stem}.ele", BACKGROUND_TRIANGLES)
        if area:
            self.write(f"{stem}.area", "2\n1 0.5\n2 0.5\n")

    def test_the_background_mesh(self):
        self.background(area=True)
        for given in ("bg.node", "bg", "bg.ele", "bg.area"):
            self.refuse_and_touch_nothing("mesh", "square.poly", "--size-mesh", given, "-o", "bg.ele",
                                          says=["bg.node", "--output", "--size-mesh"])
        self.refuse_and_touch_nothing("mesh", "square.poly", "--size-mesh", "bg.area", "--json", "bg.area",
                                      says=["bg.area", "--json", "--size-mesh"])
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "--size-mesh", "bg.node", "-o", "bg.ele",
                                      says=["bg.ele", "--output", "--size-mesh"])

    def test_the_settings(self):
        self.write("run.yaml", "input: square.poly\narea: 0.5\n")
        self.refuse_and_touch_nothing("mesh", "--config", "run.yaml", "--json", "run.yaml",
                                      says=["run.yaml", "--json", "--config"])
        self.write("own.yaml", "input: square.poly\noutput: [own.vtu]\njson: ./own.yaml\n")
        self.refuse_and_touch_nothing("mesh", "--config", "own.yaml", says=["own.yaml", "--json", "--config"])

    def test_the_decomposition(self):
        self.succeed("decompose", "square.poly", "-n", "2", "-o", "d.txt")
        self.refuse_and_touch_nothing("mesh", "square.poly", "--decomposition", "d.txt", "--json", "d.txt",
                                      says=["d.txt", "--json", "--decomposition"])
        result = self.on_ranks(2, "mesh", "square.poly", "--decomposition", "d.txt", "--json", "./d.txt")
        self.assertEqual(result.returncode, 1)
        self.assertIn("--decomposition", result.stderr)
        self.assertTrue((self.folder / "d.txt").read_text().startswith("# driftmesh decomposition"))

    def test_the_input_by_other_names(self):
        os.link(self.folder / "square.poly", self.folder / "hard.vtu")
        (self.folder / "soft.vtu").symlink_to("square.poly")
        (self.folder / "sub").mkdir()
        (self.folder / "there").symlink_to("sub")
        for name in ("square.poly", "./square.poly", "sub/../square.poly", "there/../square.poly", "hard.vtu",
                     "soft.vtu", self.folder / "square.poly"):
            self.refuse_and_touch_nothing("mesh", "square.poly", "--json", name, says=["--json", "INPUT"])
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "--plot", "square.poly", says=["not a picture"])
        (self.folder / "picture.png").symlink_to("square.poly")
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "--plot", "picture.png",
                                      says=["picture.png", "--plot", "INPUT"])
        self.refuse_and_touch_nothing("plot", "square.poly", "-o", "picture.png", says=["--output", "INPUT"])

    def test_vertices_beside_the_input(self):
        lines = SQUARE.splitlines(keepends=True)
        self.write("split.poly", "0 2 0 0\n" + "".join(lines[5:]))
        self.write("split.node", "".join(lines[:5]))
        self.refuse_and_touch_nothing("mesh", "split.poly", "--json", "split.node", says=["split.node", "--json", "INPUT"])

    def test_pieces(self):
        self.succeed("mesh", "square.poly", "-n", "4", "-o", "m.pvtu", "--area", "0.1")
        self.refuse_and_touch_nothing("convert", "m.pvtu", "m_0.vtu", says=["m_0.vtu", "OUTPUT", "INPUT"])
        (self.folder / "m.png").symlink_to("m_0.vtu")
        self.refuse_and_touch_nothing("plot", "m.pvtu", says=["m.png", "--output", "INPUT"])

    def test_two_outputs_in_one_file(self):
        (self.folder / "to").symlink_to(".")
        (self.folder / "alias.svg").symlink_to("later.vtu")
        for outputs, uses in ((["-o", "a.vtu", "--json", "a.vtu"], ["--output", "--json"]),
                              (["-o", "a.vtu", "-o", "to/a.vtu"], ["--output", "twice"]),
                              (["-o", "later.vtu", "--plot", "alias.svg"], ["--output", "--plot"]),
                              (["-o", "a.msh", "-o", "a.node", "--json", "a.neigh"], ["--output", "--json"]),
                              (["-o", "-", "--json", "-"], ["--output", "--json"])):
            self.refuse_and_touch_nothing("mesh", "square.poly", *outputs, says=uses)
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "-o", "a.svg", "--plot", "./a.svg",
                                      says=["--output", "--plot"])

    def test_the_files_of_an_experiment(self):
        self.background("run-1")
        experiment = "input: {file: square.poly}\nbounds: {triangles: 2e3}\ncluster: {ranks: 2}\nlb-statistics: 1\n"
        self.write("experiment.yaml", experiment)
        self.refuse_and_touch_nothing("run", "experiment.yaml", "-o", ".", says=["experiment.yaml", "results"])
        self.write("e.yaml", experiment)
        os.rename(self.folder / "square.poly", self.folder / "table.csv")
        self.write("square.node", BACKGROUND_NODES)
        for name in ("table.csv", "run-1.json", "run-1-time.png", "run-1.trace.json", "run-1.lb-stats/data.1.json"):
            (self.folder / "run-1.lb-stats").mkdir(exist_ok=True)
            self.write(name, SQUARE)
            self.refuse_and_touch_nothing("run", "e.yaml", "-o", ".", "--set", f"input.file={name}",
                                          says=[name, "results", "input.file"])

    def test_a_device_has_any_number_of_uses(self):
        self.succeed("mesh", "square.poly", "--json", "/dev/null", "--area", "0.5", "-o", "a.vtu")
        (self.folder / "b.vtu").symlink_to("/dev/null")
        self.succeed("mesh", "square.poly", "--json", "/dev/null", "-o", "b.vtu")


if __name__ == "__main__":
    main()

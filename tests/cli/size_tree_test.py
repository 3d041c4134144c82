#!/usr/bin/env python3
"""Compiled size fields as files: saved, used again and drawn, and what is refused.

usage: size_tree_test.py DRIFTMESH [unittest options]
"""

import json
import os
import random

from program import SQUARE, Cli, main

SEED = int(os.environ.get("DRIFTMESH_SEED", "20261126"))


class SizeTrees(Cli):
    def digest(self, *arguments):
        self.succeed("mesh", "square.poly", *arguments, "--json", "run.json")
        return json.loads((self.folder / "run.json").read_text())["mesh"]["digest"]

    def test_meshes_are_those_of_the_sources(self):
        self.write("square.poly", SQUARE)
        generator = random.Random(SEED)
        print(f"seed {SEED}")
        for _ in range(6):
            x, least, growth = generator.uniform(0, 4), generator.uniform(0.005, 0.05), generator.uniform(0.05, 0.5)
            rule = generator.choice([f"{least:.5f}+{growth:.4f}*distance()", f"x<{x:.4f}?{least:.5f}:0.5",
                                     f"{least:.5f}+{growth:.4f}*hypot(x-{x:.4f}, y-1)", f"min(0.4, {least:.5f}+{growth:.4f}*abs(y-{x:.4f}))"])
            sources = ["--size", rule, *generator.choice([[], ["--gradation", "0.25"], ["--size-min", "0.02"]])]
            with self.subTest(sources):
                plain = self.digest(*sources)
                self.assertEqual(self.digest(*sources, "--save-size-tree", "sizes.tree"), plain)
                self.assertEqual(self.digest("--size-tree", "sizes.tree"), plain)
                self.assertEqual(self.digest("--size-tree", "sizes.tree", "-n", "3"), self.digest(*sources, "-n", "3"))
                self.assertEqual(self.digest("--size-tree", "sizes.tree", "--angle", "28"), self.digest(*sources, "--angle", "28"))
        self.succeed("plot", "square.poly", "--size-tree", "sizes.tree", "-o", "sizes.svg")
        self.succeed("plot", "square.poly", *sources, "-o", "sources.svg")
        self.assertEqual(*(self.folder.joinpath(name).read_text().replace(name, "") for name in ("sizes.svg", "sources.svg")))

    def test_a_background_mesh(self):
        self.write("square.poly", SQUARE)
        self.write("back.node", "5 2 1 0\n0 0 0 0.05\n1 4 0 0.5\n2 4 4 0.5\n3 0 4 0.5\n4 2 2 0.1\n")
        self.write("back.ele", "4 3 0\n0 0 1 4\n1 1 2 4\n2 2 3 4\n3 3 0 4\n")
        plain = self.digest("--size-mesh", "back", "--gradation", "0.2", "-o", "a.vtu")
        self.succeed("check", "a.vtu", "square.poly", "--size-mesh", "back", "--gradation", "0.2")
        self.digest("--size-mesh", "back", "--gradation", "0.2", "--save-size-tree", "sizes.tree")
        self.assertEqual(self.digest("--size-tree", "sizes.tree"), plain)

    def test_what_is_refused(self):
        self.write("square.poly", SQUARE)
        self.write("other.poly", SQUARE.replace("3 4 4", "3 4 5", 1))
        self.digest("--size", "0.1+0.1*x", "--save-size-tree", "sizes.tree")
        whole = (self.folder / "sizes.tree").read_bytes()
        tree = ["--size-tree", "sizes.tree"]
        self.refuse("mesh", "other.poly", *tree, says=["sizes.tree", "another domain"])
        self.refuse("mesh", "square.poly", *tree, "--size", "1", code=2, says=["--size-tree", "--size"])
        self.refuse("mesh", "square.poly", *tree, "--triangles", "100", code=2, says=["--size-tree"])
        self.refuse("mesh", "square.poly", "--area", "1", "--save-size-tree", "b.tree", code=2, says=["--save-size-tree"])
        self.refuse("mesh", "square.poly", "--size", "1", "--save-size-tree", "square.poly", says=["square.poly"])
        self.refuse("mesh", "square.poly", "--size-tree", "square.poly", says=["square.poly", "no compiled size field"])
        line = whole.index(b"\n") + 1
        for damaged, says in ((whole[:line] + b"\7" + whole[line + 1:], "version 7"), (whole[:-5], "damaged"),
                              (whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:], "damaged"), (whole[:line + 3], "damaged")):
            self.write("sizes.tree", damaged)
            self.refuse("mesh", "square.poly", *tree, says=["sizes.tree", says])
        # Known at points alone: nothing is written.
        self.refuse("mesh", "square.poly", "--size", "0.5 + 0.1*rint(1e4*(x-x))", "--save-size-tree", "c.tree",
                    says=["c.tree", "at points alone"])
        self.assertFalse({"b.tree", "c.tree"}.intersection(self.files()))


if __name__ == "__main__":
    main()

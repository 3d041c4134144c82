#!/usr/bin/env python3
"""A policy in a shared library is like one of the program's own.

usage: policy_library_test.py DRIFTMESH FOLDER [unittest options]        (FOLDER has the libraries)
"""

import csv
import json
import pathlib
import shutil
import sys

from program import SQUARE, Cli, main

LIBRARIES = None

EXPERIMENT = """
input: {generate: pipe}
bounds: {triangles-per-rank: 2000}
decomposition: {subdomains-per-rank: 10}
cluster: {groups: [{ranks: 2, speed: 1e4}, {ranks: 2, speed: 4e4}]}
mapping: {method: block}
report: false
balance: {parameters: {pairs.so.share: 0.8}}
sweep: {balance.policy: [none, greedy, plugins/pairs.so]}
"""


class PolicyLibrary(Cli):
    def setUp(self):
        super().setUp()
        (self.folder / "plugins").mkdir()
        for name in ("pairs", "pairs_of_another_version", "no_policy"):
            shutil.copy(LIBRARIES / f"{name}.so", self.folder / "plugins")

    def test_an_experiment_names_it_among_others(self):
        (self.folder / "sub").mkdir()
        shutil.move(self.folder / "plugins", self.folder / "sub" / "plugins")
        self.write("sub/x.yaml", EXPERIMENT)
        self.succeed("run", "sub/x.yaml", "-o", "x", "--quiet", "--allow-code")
        with open(self.folder / "x" / "table.csv", encoding="utf-8") as file:
            seconds = [float(row["seconds"]) for row in csv.DictReader(file)]
        self.assertEqual(len(seconds), 3)
        self.assertLess(seconds[2], 0.8 * seconds[0])
        record = json.loads((self.folder / "x" / "run-3.json").read_text())
        self.assertGreater(len(record["cluster"]["moves"]), 0)
        # What it was given tells: with another share it moves something else.
        self.succeed("run", "sub/x.yaml", "-o", "y", "--quiet", "--allow-code", "--set", "balance.parameters={pairs.so.share: 0.1}")
        other = json.loads((self.folder / "y" / "run-3.json").read_text())
        self.assertNotEqual(len(record["cluster"]["moves"]), len(other["cluster"]["moves"]))
        # The experiment that is written beside the results names it from anywhere.
        self.succeed("run", "x/experiment.yaml", "-o", "z", "--quiet", "--allow-code")
        said = self.succeed("replay", "x/run-1.json", "--policy", "none", "--policy", "sub/plugins/pairs.so")
        self.assertIn(" pairs.so |", said)

    def test_ranks_load_it(self):
        self.write("in.poly", SQUARE)
        result = self.on_ranks(2, "mesh", "in.poly", "-n", "30", "--area", "0.0005", "--drag", "1,0.3", "--balance",
                               "plugins/pairs.so", "-o", "m.pvtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("accepted", self.succeed("check", "m.pvtu", "in.poly", "--area", "0.0005"))

    def test_a_file_does_not_run_code_by_itself(self):
        """text.so would be refused in other words if it were opened."""
        self.write("plugins/text.so", "no library")
        for library in ("plugins/pairs.so", "plugins/text.so", "none.so"):
            for policy in (f"balance: {{policy: {library}}}\n", f"sweep: {{balance.policy: [none, {library}]}}\n"):
                self.write("x.yaml", "input: {generate: pipe}\nbounds: {triangles: 2000}\ncluster: {ranks: 2}\n" + policy)
                for more in ((), ("--dry-run",), ("--set", "bounds.angle=25")):
                    self.refuse("run", "x.yaml", *more, says=["x.yaml:4:", "'balance.policy' is code", library, "--allow-code"])
            self.write("c.yaml", f"input: in.poly\nn: 4\nbalance: {library}\n".replace("n: 4", "subdomains: 4"))
            self.write("in.poly", SQUARE)
            result = self.on_ranks(2, "mesh", "--config", "c.yaml", "-o", "m.pvtu")
            self.assertNotEqual(result.returncode, 0)
            for word in ("c.yaml:3:", "'balance.policy' is code", library, "--allow-code"):
                self.assertIn(word, result.stderr)
        self.write("x.yaml", EXPERIMENT)
        self.succeed("run", "x.yaml", "--quiet", "-o", "set", "--set", "balance.policy=plugins/pairs.so")
        self.write("c.yaml", "input: in.poly\nsubdomains: 4\nbalance: plugins/pairs.so\n")
        for more in (("--allow-code",), ("--balance", "plugins/pairs.so"), ("--balance", "none")):
            result = self.on_ranks(2, "mesh", "--config", "c.yaml", "-o", "m.pvtu", *more)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_what_is_no_policy_is_refused(self):
        self.write("x.yaml", EXPERIMENT)
        self.write("text.so", "no library")
        for library, words in (("plugins/no_policy.so", ["no_policy.so", "has no policy", "DRIFTMESH_POLICY"]),
                               ("plugins/pairs_of_another_version.so", ["was built for driftmesh 0.0.0"]),
                               ("text.so", ["text.so", "cannot be loaded"]), ("none.so", ["none.so", "cannot be loaded"])):
            self.refuse("run", "x.yaml", "-o", "x", "--set", f"balance.policy={library}", says=words)
        self.refuse("run", "x.yaml", "-o", "x", "--allow-code", "--set", "balance.parameters={pairs.so.shares: 1}",
                    says=["policy pairs", "unknown parameter 'shares'"])
        self.assertFalse((self.folder / "x").exists())


if __name__ == "__main__":
    LIBRARIES = pathlib.Path(sys.argv.pop(2)).resolve()
    main()

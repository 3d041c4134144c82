#!/usr/bin/env python3
"""Meshes that do not depend on the number of ranks or threads: --method rounds.

usage: rounds_test.py DRIFTMESH [unittest options]
"""

import json

import program

# Without cuts to size beforehand, so that interfaces get points in refinement, and several rounds are needed.
REQUEST = ("--generate", "pipe", "--area", "1", "--presplit", "off", "-n", "12")


class Rounds(program.Cli):
    def digest(self, arguments, ranks=None):
        command = ("mesh", *arguments, "--quiet", "--json", "run.json")
        if ranks is None:
            self.succeed(*command)
        else:
            result = self.on_ranks(ranks, *command)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        record = json.loads((self.folder / "run.json").read_text())
        return record["mesh"]["digest"], record["parts"]["rounds"]

    def test_same_mesh_on_ranks_and_threads(self):
        by_one, rounds = self.digest((*REQUEST, "--reproducible", "--threads", "1"))
        self.assertGreater(rounds, 1)
        self.assertEqual(self.digest((*REQUEST, "--method", "rounds", "--threads", "3")), (by_one, rounds))
        for ranks in (1, 2, 3):
            self.assertEqual(self.digest((*REQUEST, "--reproducible"), ranks), (by_one, rounds))
        self.assertEqual(self.digest((*REQUEST, "--reproducible", "--threads", "2"), 2), (by_one, rounds))

    def test_files_of_ranks(self):
        result = self.on_ranks(3, "mesh", *REQUEST, "--reproducible", "-o", "a.pvtu", "-o", "a.h5", "-o", "a.msh")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("in ", result.stdout)
        for name in ("a.pvtu", "a.h5", "a.msh"):
            self.assertIn("accepted", self.succeed("check", name))
        for part in range(3):
            self.assertTrue((self.folder / f"a_{part}.vtu").exists())

    def test_what_does_not_go_together(self):
        self.refuse("mesh", *REQUEST, "--reproducible", "--method", "coupled", code=2,
                    says=["--reproducible", "--method"])
        self.refuse("mesh", *REQUEST[:-2], "--reproducible", "-n", "1", code=2, says=["--method", "--subdomains", "one piece"])
        result = self.on_ranks(2, "mesh", *REQUEST, "--reproducible", "--balance", "stealing")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("--balance", result.stderr)
        self.assertIn("--method", result.stderr)


if __name__ == "__main__":
    program.main()

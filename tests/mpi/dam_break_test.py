#!/usr/bin/env python3
"""The example dam_break: it loses no water, moves subdomains, and computes the same on any number of ranks.

usage: dam_break_test.py MPIEXEC DAM_BREAK [unittest options]
"""

import re
import subprocess
import sys
import unittest

MPIEXEC, PROGRAM = sys.argv[1:3]


def run(ranks):
    command = [MPIEXEC, "--oversubscribe", "-n", str(ranks), PROGRAM, "0.4", "1.5"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class DamBreak(unittest.TestCase):
    def test_ranks_compute_the_same(self):
        said = {ranks: run(ranks) for ranks in (1, 2, 3)}
        results = {ranks: re.search(r"^(.*meshes of \d+ triangles).*\n(the water climbs .* of the beach);", text) for ranks, text in said.items()}
        self.assertTrue(all(results.values()), said)
        self.assertEqual(len({result.groups() for result in results.values()}), 1, said)
        self.assertGreater(int(re.search(r"(\d+) moves", said[3])[1]), 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

#!/usr/bin/env python3
"""The example dam_break: it loses no water, moves subdomains, computes the same on any number of ranks, and writes a film.

usage: dam_break_test.py MPIEXEC DAM_BREAK [--driftmesh PROGRAM] [unittest options]

--driftmesh: a program that has the command report, which makes a page of the film.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest

MPIEXEC, PROGRAM = sys.argv[1:3]
DRIFTMESH = sys.argv[4] if sys.argv[3:4] == ["--driftmesh"] else None


def run(ranks, seconds="1.5", *film):
    command = [MPIEXEC, "--oversubscribe", "-n", str(ranks), PROGRAM, "0.4", seconds, *film]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class DamBreak(unittest.TestCase):
    def test_ranks_compute_the_same(self):
        said = {ranks: run(ranks) for ranks in (1, 2, 3)}
        results = {ranks: re.search(r"^(.*meshes of \d+ triangles).*\n(the water climbs .* of the beach);", text) for ranks, text in said.items()}
        self.assertTrue(all(results.values()), said)
        self.assertEqual(len({result.groups() for result in results.values()}), 1, said)
        self.assertGreater(int(re.search(r"(\d+) moves", said[3])[1]), 0)

    @unittest.skipUnless(DRIFTMESH, "THE PROGRAM HAS NO COMMAND report")
    def test_the_film_is_played(self):
        with tempfile.TemporaryDirectory() as folder:
            film, page = os.path.join(folder, "dam.pvd"), os.path.join(folder, "dam.html")
            run(2, "0.5", film)
            said = subprocess.run([DRIFTMESH, "report", film, "--field", "depth", "-o", page], check=True, capture_output=True, text=True).stdout
            self.assertEqual(said, f"{page}: 6 frames\n")
            with open(page, encoding="utf-8") as file:
                text = file.read()
        times = [float(time) for time in re.findall(r'data-frame="values"[^>]* data-time="([^"]*)"', text)]
        self.assertEqual(len(times), 6)
        for k, time in enumerate(times):
            self.assertLess(abs(time - 0.1 * k), 0.1)
        self.assertRegex(text, r'data-field="depth" data-at="points" data-middle="20 10" data-box="-20 -10 20 10" data-range="0 2"')


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[5 if DRIFTMESH else 3:]])

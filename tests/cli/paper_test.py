#!/usr/bin/env python3
"""The paper's tables and figures from one command, at a tiny size.

usage: paper_test.py PAPER.SH DRIFTMESH [unittest options]
"""

import csv
import pathlib
import re
import subprocess
import sys

import program
from program import RANKS_ENVIRONMENT, Cli, main

SCRIPT = pathlib.Path(sys.argv.pop(1)).resolve()


class Paper(Cli):
    def rows(self, name):
        with open(self.folder / "paper" / f"{name}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_every_table_is_made(self):
        result = subprocess.run([SCRIPT, "--small", "--program", program.PATH, "paper"], cwd=self.folder, check=False,
                                capture_output=True, text=True, timeout=500, env=RANKS_ENVIRONMENT)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual({row["model"] for row in self.rows("table-1")}, {"pipe", "cylinder-flow", "bay"})
        self.assertEqual(len(self.rows("table-2")), 6)
        self.assertEqual({row["messages"] for row in self.rows("table-3") if row["method"] == "decoupled"}, {"0"})
        self.assertEqual({row["method"] for row in self.rows("table-3") if row["model"] == "pipe"},
                         {"published: PCDM", "published: PDR", "PCDM", "PDR", "presplit", "decoupled"})
        for row in self.rows("table-3-real"):
            if row["method"] != "presplit":
                self.assertEqual(int(row["points sent"] or 0) > 0, row["method"] in ("PCDM", "PDR"), row)
        self.assertEqual(len(self.rows("fig-10")), 12)
        self.assertEqual(len(self.rows("fig-11")), 9)
        self.assertEqual({row["policy"] for row in self.rows("replay")}, {"none", "greedy"})
        alone, some, most = self.rows("fig-7")
        for mapping in ("round-robin: ", "graph: "):
            self.assertEqual(alone[f"{mapping}points sent"], alone[f"{mapping}messages"])
            self.assertGreater(int(some[f"{mapping}messages"]), int(most[f"{mapping}messages"]))
        text = (self.folder / "paper" / "paper.md").read_text()
        self.assertIn("--small", text)
        for name in ("table-1", "table-1-real", "table-2", "table-3", "table-3-real", "fig-7", "fig-10", "fig-10-modern", "fig-11", "replay"):
            self.assertIn((self.folder / "paper" / f"{name}.md").read_text(), text)
        page = (self.folder / "paper" / "paper.html").read_text()
        self.assertEqual((page.count("<table>"), page.count("<svg ")), (10, 3))
        self.assertIn('<td class="published">0.606</td>', page)
        for link in re.findall(r'href="([^"#]+)"', page):
            self.assertTrue((self.folder / "paper" / link).exists(), link)
        for name in ("fig-7", "fig-10", "fig-10-modern"):
            self.assertTrue((self.folder / "paper" / f"{name}.svg").read_text().endswith("</svg>\n"))

    def test_unknown_options_are_refused(self):
        for words in (["--tiny"], ["--program"]):
            result = subprocess.run([SCRIPT, *words], capture_output=True, text=True, check=False)
            self.assertEqual((result.returncode, result.stdout), (2, ""))
            self.assertIn("paper.sh: ", result.stderr)


if __name__ == "__main__":
    main()

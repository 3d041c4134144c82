#!/usr/bin/env python3
"""Everything that states a version agrees with include/driftmesh/version.hpp.

usage: version_test.py PROJECT_FOLDER VERSION_OF_THE_BUILD PROGRAM
"""

import pathlib
import re
import subprocess
import sys
import unittest

import yaml

ROOT, BUILD_VERSION, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
HEADER = (ROOT / "include/driftmesh/version.hpp").read_text()
VERSION = ".".join(re.search(rf"DRIFTMESH_VERSION_{part} (\d+)", HEADER)[1] for part in ("MAJOR", "MINOR", "PATCH"))


class Version(unittest.TestCase):
    def test_build(self):
        self.assertEqual(BUILD_VERSION, VERSION)

    def test_program(self):
        said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said.split()[:2], ["driftmesh", VERSION])

    def test_changelog(self):
        """What is not released stands at most once, before the newest release, which has a date."""
        entries = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
        released = entries[1:] if entries[0] == "Unreleased" else entries
        self.assertNotIn("Unreleased", released)
        self.assertRegex(released[0], rf"^{re.escape(VERSION)} - \d{{4}}-\d{{2}}-\d{{2}}$")

    def test_citation(self):
        citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
        self.assertEqual(citation["version"], VERSION)
        for key in ("cff-version", "message", "title", "authors", "license"):
            self.assertIn(key, citation)
        for reference in citation["references"]:
            self.assertLessEqual({"type", "title", "authors", "journal", "volume", "year"}, reference.keys())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

#!/usr/bin/env python3
"""Pages of results (docs/results) say where each table comes from, by a script that is there and can make it anew; tables are put into
them without touching the rest; and the pages that draw conclusions stay short.

usage: results_test.py PROJECT_FOLDER
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path(sys.argv.pop(1)).resolve()
sys.dont_write_bytecode = True
sys.path.append(str(PROJECT / "scripts" / "tables"))

import results  # noqa: E402
from marked import lines_below, marks_of  # noqa: E402
from table import Table  # noqa: E402

PAGES = sorted((PROJECT / results.FOLDER).glob("*.md"))
BY_HAND = "by-hand.md"
WHERE_FROM = "*2026-01-02, commit 0123abc; 2 cores, a processor, a compiler*"


class Results(unittest.TestCase):
    def test_every_table_says_where_it_comes_from(self):
        self.assertGreater(len(PAGES), 5)
        for page in PAGES:
            _, sections = results.sections_of(page.read_text())
            self.assertGreater(len(sections), 0, page)
            for section in sections:
                title, _, where_from, *_ = section.splitlines()
                with self.subTest(page=page.name, section=title):
                    self.assertRegex(where_from, results.ORIGIN)
                    marks = marks_of(section)
                    if page.name == BY_HAND:
                        self.assertEqual(marks, [])
                        self.assertRegex(section, "`(mpirun -n [0-9]+ )?driftmesh ")
                        continue
                    (name, script), = marks
                    self.assertEqual(pathlib.Path(script).stem, page.stem)
                    self.assertGreater(len(lines_below(section, script)[name]), 2)

    def test_scripts_make_them_anew(self):
        scripts = {script for page in PAGES for _, script in marks_of(page.read_text())}
        self.assertEqual(len(scripts), len(PAGES) - 1)
        for script in scripts:
            done = subprocess.run([PROJECT / script, "--help"], capture_output=True, text=True, check=True)
            self.assertIn("--update", done.stdout, script)

    def test_only_the_sections_of_the_tables_change(self):
        with tempfile.TemporaryDirectory() as name:
            project = pathlib.Path(name)
            page = project / results.FOLDER / "ranks.md"
            page.parent.mkdir(parents=True)
            table = Table("one", "One", ["a", "b"], "Notes.", [(1, "x"), (2345, "y")])
            page.write_text("# Results\n\nHow.\n\n## Old one\n\nOld.\n\n<!-- table: one, by bench/ranks.py -->\n\n| a |\n|---|\n\nOld.\n\n"
                            "## Two\n\n<!-- table: two, by bench/ranks.py -->\n\n| a |\n|---|\n")
            results.update("bench/ranks.py", [table, Table("new", "New", ["c"], "", [("z",)])], WHERE_FROM, project)
            self.assertEqual(page.read_text(),
                             f"# Results\n\nHow.\n\n## One\n\n{WHERE_FROM}\n\n<!-- table: one, by bench/ranks.py -->\n\n"
                             "| a | b |\n| --- | --- |\n| 1 | x |\n| 2,345 | y |\n\nNotes.\n\n"
                             "## Two\n\n<!-- table: two, by bench/ranks.py -->\n\n| a |\n|---|\n\n"
                             f"## New\n\n{WHERE_FROM}\n\n<!-- table: new, by bench/ranks.py -->\n\n| c |\n| --- |\n| z |\n")

    def test_the_origin_names_date_commit_and_machine(self):
        with tempfile.NamedTemporaryFile("w", suffix=".sh", delete=False) as file:
            file.write("#!/bin/sh\necho 'driftmesh 1.2.3'\necho 'compiler: GCC 1.2'\n")
        program = pathlib.Path(file.name)
        program.chmod(0o755)
        try:
            if not (PROJECT / ".git").exists() or not shutil.which("git"):
                self.skipTest("no repository, or no git")
            line = results.origin(program)
        finally:
            program.unlink()
        self.assertRegex(line, results.ORIGIN)
        self.assertTrue(line.endswith(", GCC 1.2*"), line)

    def test_conclusions_are_short(self):
        for name in ("balancing.md", "benchmarks.md"):
            self.assertLessEqual(len((PROJECT / "docs" / name).read_text().splitlines()), 350, name)


if __name__ == "__main__":
    unittest.main()

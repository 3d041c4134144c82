#!/usr/bin/env python3
"""The tables of balancing from one command, at a tiny size; and that documents show these tables, and no others.

usage: balancing_test.py BALANCING.SH DRIFTMESH [unittest options]
"""

import pathlib
import shutil
import subprocess
import sys

import program
from program import Cli, main

SCRIPT = pathlib.Path(sys.argv.pop(1)).resolve()
PROJECT = SCRIPT.parent.parent
sys.dont_write_bytecode = True
sys.path += [str(SCRIPT.parent / "balancing"), str(SCRIPT.parent / "tables")]
ORIGIN = "*2026-01-02, commit 0123abc; 2 cores, a processor, a compiler*"

from experiments import EXPERIMENTS  # noqa: E402
from command import PATH, pages  # noqa: E402
from marked import lines_below, marks_of, with_tables  # noqa: E402
from results import FOLDER, sections_of  # noqa: E402
from tables import TABLES  # noqa: E402


def cells(line):
    return [cell.strip() for cell in line[1:-1].split("|")]


def labels(lines, keys):
    """The columns, and of each row the first cells, which tell rows apart."""
    return [cells(lines[0]), *(cells(line)[:keys] for line in lines[2:])]


def headings(text):
    return [line for line in text.splitlines() if line.startswith("## ")]


class Balancing(Cli):
    def test_every_table_is_made_and_documented(self):
        result = subprocess.run([SCRIPT, "--small", "--program", program.PATH, "out"], cwd=self.folder, check=False,
                                capture_output=True, text=True, timeout=500)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        out = self.folder / "out"
        whole = (out / "balancing.md").read_text()
        self.assertIn("--small", whole)
        documented = {}
        for page in pages(PROJECT):
            for name, lines in lines_below(page.read_text(), PATH).items():
                documented.setdefault(name, []).append((page, lines))
        for name, table in TABLES.items():
            with self.subTest(table=name):
                text = (out / f"{name}.md").read_text()
                self.assertIn(text, whole)
                made = [line for line in text.splitlines() if line.startswith("|")]
                self.assertGreater(len(made), 3)
                self.assertIn(PROJECT / FOLDER / "balancing.md", {page for page, _ in documented[name]})
                for page, lines in documented[name]:
                    self.assertEqual(labels(lines, table.keys), labels(made, table.keys), page)
                self.assertEqual(len((out / f"{name}.csv").read_text().splitlines()), len(made) - 1)
        self.updated_from(out)

    def updated_from(self, out):
        """Copies of pages get the tables of `out`, and nothing else in them changes."""
        project = self.folder / "project"
        for page in pages(PROJECT):
            copy = project / page.relative_to(PROJECT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(page, copy)
        command = [sys.executable, SCRIPT.parent / "balancing" / "command.py", "update", out, project, ORIGIN]
        environment = {"PYTHONPATH": str(SCRIPT.parent / "tables"), "PYTHONDONTWRITEBYTECODE": "1", "LC_ALL": "C.UTF-8"}
        first = subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout
        self.assertIn("docs/balancing.md: ", first)
        self.assertIn("configs/late-hosts.yaml: late-hosts\n", first)
        results = (project / FOLDER / "balancing.md").read_text()
        self.assertEqual(results.count(ORIGIN), len(sections_of(results)[1]))
        for page in pages(PROJECT):
            old, new = page.read_text(), (project / page.relative_to(PROJECT)).read_text()
            self.assertEqual(marks_of(new), marks_of(old))
            empty = {name: [] for name, script in marks_of(old) if script == PATH}
            if page == PROJECT / FOLDER / "balancing.md":
                self.assertEqual(sections_of(new)[0], sections_of(old)[0])
                self.assertEqual(headings(new), headings(old))
            else:
                self.assertEqual(with_tables(new, empty), with_tables(old, empty), page)
            self.assertEqual(with_tables(with_tables(new, empty), lines_below(new, PATH)), new, page)
            for name, lines in lines_below(new, PATH).items():
                made = [line for line in (out / f"{name}.md").read_text().splitlines() if line.startswith("|")]
                self.assertEqual(lines, made)
        self.assertEqual(subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout, "")

    def test_every_mark_names_a_table(self):
        marks = [mark for page in pages(PROJECT) for mark in marks_of(page.read_text())]
        self.assertGreaterEqual(len(marks), len(TABLES))
        for name, script in marks:
            if script == PATH:
                self.assertIn(name, TABLES)

    def test_every_experiment_is_for_a_table(self):
        used = {name for table in TABLES.values() for name in table.experiments if table is not TABLES["costs"]}
        self.assertEqual(used, set(EXPERIMENTS))

    def test_wrong_calls_are_refused(self):
        for words, says in ((["--tiny"], "--tiny"), (["--program"], "--program"), (["out", "sciclon"], "sciclon"),
                            (["--small", "--update"], "--update"), (["--inputs", "nowhere"], "nowhere")):
            result = subprocess.run([SCRIPT, *words], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual((result.returncode, result.stdout), (2, ""), words)
            self.assertIn("balancing.sh: ", result.stderr)
            self.assertIn(says, result.stderr)
            self.assertEqual(self.files(), [])


if __name__ == "__main__":
    main()

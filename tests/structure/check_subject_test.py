#!/usr/bin/env python3
"""check_subject.py finds long subjects, and the hooks of .pre-commit-config.yaml run what exists.

usage: check_subject_test.py PROJECT_FOLDER [unittest options]
"""

import pathlib
import re
import sys
import unittest

from check_subject import problem_of, subject_of

PROJECT = pathlib.Path(sys.argv.pop(1))


class CheckSubject(unittest.TestCase):
    def test_the_subject_is_the_first_line_that_is_no_remark(self):
        self.assertEqual(subject_of("\n# remark\nMerge points \n\nWhy.\n"), "Merge points")
        self.assertEqual(subject_of(""), "")

    def test_characters_are_counted_not_bytes(self):
        self.assertEqual(problem_of("ä" * 72 + "\n\n" + "x" * 100), "")
        self.assertIn("73 characters", problem_of("ä" * 73))

    def test_hooks_run_what_exists(self):
        scripts = re.findall(r"entry: python3 (\S+)", (PROJECT / ".pre-commit-config.yaml").read_text())
        self.assertEqual(len(scripts), 3)
        for script in scripts:
            self.assertTrue((PROJECT / script).is_file(), script)


if __name__ == "__main__":
    unittest.main()

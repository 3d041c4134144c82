#!/usr/bin/env python3
"""check_stages.py finds who composes stages.

usage: check_stages_test.py [unittest options]
"""

import pathlib
import tempfile
import unittest

import check_stages

MAKE = """
Domain domain = read_domain(request); Triangulated t = triangulate_domain(request, domain); check_capacity(t);
Prepared p = prepare(request, t); place.refine(std::move(p));
"""


class CheckStages(unittest.TestCase):
    def found(self, **files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {"src/job/make.cpp": MAKE, **files}.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check_stages.problems(folder)

    def test_one_composer_is_right(self):
        self.assertEqual(self.found(), [])
        self.assertEqual(self.found(**{"src/app/cmd.cpp": "job::Domain d = job::read_domain(request, {}, view);"}), [])
        self.assertEqual(self.found(**{"src/app/cmd.cpp": '// read_domain() then prepare()\nsay("triangulate_domain(x)");'}), [])
        self.assertEqual(self.found(**{"src/job/prepare.cpp": "plan_run(decompose_for(mesh), bounds);"}), [])

    def test_a_second_one_is_found(self):
        for text in ["job::read_domain(r); job::prepare(r);", "triangulate_domain(d);\n job::ThreadRun run(order, 2);",
                     "auto x = std::make_unique<ThreadRun>(order); job::find_limits(l);"]:
            found = self.found(**{"src/app/cmd.cpp": text})
            self.assertEqual(len(found), 1, text)
            self.assertIn("src/app/cmd.cpp", found[0])

    def test_names_that_are_gone_are_found(self):
        self.assertIn("does not call refine", self.found(**{"src/job/make.cpp": MAKE.replace("place.refine", "place.go")})[0])


if __name__ == "__main__":
    unittest.main()

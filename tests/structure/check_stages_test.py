#!/usr/bin/env python3
"""check_stages.py finds who composes stages.

usage: check_stages_test.py [unittest options]
"""

import pathlib
import tempfile
import unittest
import unittest.mock

import check_stages

MAKE = """
Domain domain = read_domain(request); Triangulated t = triangulate_domain(request, domain); check_capacity(t);
Prepared p = prepare(request, t); place.refine(std::move(p));
"""


class CheckStages(unittest.TestCase):
    def found(self, of_a_stage=None, **files):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(check_stages, "OF_A_STAGE", of_a_stage or {}):
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

    def test_a_maker_in_tests_is_found(self):
        for text in ["Triangulation mesh = triangulate(pslg); Refiner refiner(mesh, bounds);",
                     "auto d = decompose(testing::prepared(pslg), options);", "Refiner(triangulate(pslg), bounds).refine();",
                     "RefinementInRounds refinement{plan_run(d, bounds, options)};"]:
            found = self.found(**{"tests/property/some_test.cpp": text})
            self.assertEqual(len(found), 1, text)
            self.assertIn("tests/property/some_test.cpp: composes", found[0])
            self.assertEqual(self.found(**{"tests/unit/some_test.cpp": text}), [])

    def test_a_test_may_make_meshes_or_call_one_stage(self):
        for text in ["made(pslg, bounded(20));", "Triangulation mesh = triangulate(pslg); prepare_corners(mesh);",
                     "Refiner refiner(mesh, bounds);", "// triangulate(pslg), Refiner(mesh)"]:
            self.assertEqual(self.found(**{"bench/some.cpp": text}), [])

    def test_tests_of_a_stage_are_listed(self):
        text = "Triangulation mesh = triangulate(pslg); Refiner refiner(mesh, bounds);"
        self.assertEqual(self.found({"tests/sim/some.cpp": "why"}, **{"tests/sim/some.cpp": text}), [])
        self.assertEqual(self.found({"tests/sim/": "why"}, **{"tests/sim/some.cpp": text}), [])
        self.assertIn("remove it from OF_A_STAGE", self.found({"tests/sim/some.cpp": "why"}, **{"tests/sim/some.cpp": "f();"})[0])

    def test_names_that_are_gone_are_found(self):
        self.assertIn("does not call refine", self.found(**{"src/job/make.cpp": MAKE.replace("place.refine", "place.go")})[0])


if __name__ == "__main__":
    unittest.main()

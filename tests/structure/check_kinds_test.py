#!/usr/bin/env python3
"""check_kinds.py finds who knows a kind of bound.

usage: check_kinds_test.py [unittest options]
"""

import pathlib
import tempfile
import unittest

import check_kinds

BOUNDS = """
struct PlainBounds {
  double area = 0;           ///< largest; <= 0: none
  bool region_areas = true;  ///< flag
};
"""


class CheckKinds(unittest.TestCase):
    def found(self, **files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {"src/mesh/bounds.hpp": BOUNDS, **files}.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check_kinds.problems(folder)

    def test_who_asks_all_kinds_is_right(self):
        for text in ["sizes.length_at(p); sizes.falls_below(t, h);", "// bounds.plain.area", "areas_.sizes().least_near(t);", "context.bounds.size = own;"]:
            self.assertEqual(self.found(**{"src/mesh/refiner.cpp": text}), [])
        self.assertEqual(self.found(**{"src/mesh/size_bound.cpp": "b.plain.area; f->edge_length(p);"}), [])
        self.assertEqual(self.found(**{"src/runtime/plan_bytes.cpp": "stream.array(plan.bounds.region_max_area);"}), [])

    def test_who_knows_one_is_found(self):
        for text in ["bounds.plain.area > 0", "bounds_.plain.region_areas", "bounds.region_max_area[label]", "bounds.size != nullptr",
                     "field_.edge_length(p)", "size_->falls_below(t, h)"]:
            for name in ["src/mesh/refiner.cpp", "src/decompose/work.hpp", "migration/subdomain.cpp"]:
                self.assertEqual(len(self.found(**{name: text})), 1, text)

    def test_every_plain_value_counts(self):
        more = BOUNDS.replace("  bool", "  double edge{};\n  bool")
        self.assertEqual(check_kinds.members_of("PlainBounds", more), ["area", "edge", "region_areas"])
        self.assertEqual(len(self.found(**{"src/mesh/bounds.hpp": more, "src/mesh/refiner.cpp": "if (bounds.plain.edge > 0) f();"})), 1)

    def test_a_name_that_is_gone_is_found(self):
        self.assertIn("has no PlainBounds", self.found(**{"src/mesh/bounds.hpp": ""})[0])


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""The faults of the mutation gate stand in the sources, and are put into them as their format says.

usage: faults_test.py [unittest options]
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

import faults  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = """
int twice(int a) {
  if (a < 0) return 0;
  a += 1;
  return a * 2 - 2;
}
int thrice(int a) {
  a += 1;
  return a * 3 - 3;
}
"""
DATA = """
file twice.hpp
? negative numbers count
- a < 0
+ a < -5
? 0 does not count
- a < 0
+ a <= 0
? a is as it was
@ int thrice
- a += 1;
+
? one too few
@ int twice
- return a * 2 - 2;
+ return a * 2 - 4;
? four times
@ int twice
- a * 2
+ a * 4 - 2
"""
MAIN = """
#include <cstdio>
#include "twice.hpp"
int main() { std::printf("%d %d %d %d", twice(-3), twice(0), twice(4), thrice(2)); }
"""


class Faults(unittest.TestCase):
    def test_what_is_replaced_is_the_whole_of_an_expression(self):
        for text, before, behind, whole in [("a || b", "if (", ")", True), ("a || b", "if (", " != c)", False), ("a || b", "if (c || ", ")", True),
                                            ("a || b", "if (c && ", ")", False), ("a && b", "if (c || ", ")", True), ("a == b", "if (!", ")", False),
                                            ("f(a || b)", "if (!", " && c)", True), ("b - c", "x = a - ", ";", False), ("b * c", "x = a - ", ";", True),
                                            ("a ? b : c", "f(", ", d)", True), ("a ? b : c", "f(1 + ", ")", False),
                                            ("f(a, b", "x = ", ");", False), ("a, b)", "f(", ";", False), ("if (a) b", "", " = c;", False)]:
            with self.subTest(text=text, before=before, behind=behind):
                self.assertEqual(faults.is_whole(text, before, behind), whole)

    def test_data_matches_the_sources(self):
        for fault in faults.read():
            with self.subTest(fault.line):
                faults.span_of(fault, (ROOT / fault.file).read_text())
                self.assertNotEqual(fault.right.split(), fault.wrong.split())

    def test_sources_with_all_faults_can_be_made(self):
        by_file = {}
        for fault in faults.read():
            by_file.setdefault(fault.file, []).append(fault)
        for file, some in by_file.items():
            text = faults.schemata((ROOT / file).read_text(), some)
            self.assertEqual(sum(text.count(f"({f.number}U)") for f in some), len(some), file)

    def test_each_fault_is_alone(self):
        data = faults.parse(DATA, "box")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "twice.hpp").write_text(faults.schemata(SOURCE, data))
            (folder / "main.cpp").write_text(MAIN)
            subprocess.run(["c++", "-std=c++20", "-Werror", "-I", str(ROOT), "-I", name, str(folder / "main.cpp"), "-o", str(folder / "main")], check=True)
            seen = {}
            for number in [0, *[f.number for f in data]]:
                passed = folder / "passed"
                passed.write_bytes(bytes(1 << 16))
                seen[number] = subprocess.run([str(folder / "main")], check=True, capture_output=True, text=True,
                                              env={"DRIFTMESH_FAULT": str(number), "DRIFTMESH_FAULTS_PASSED": str(passed)}).stdout
                places = passed.read_bytes()
                self.assertTrue(all(places[f.number % (1 << 16)] for f in data[2:4]))
        self.assertEqual([seen[n] for n in seen], ["0 0 8 6", "-6 0 8 6", "0 0 8 6", "0 0 8 3", "0 -2 6 6", "0 0 16 6"])

    def test_mistakes_are_refused(self):
        for data, why in [("? no file\n- a\n+ b", "needs a file"), ("file f\n? nothing to put\n- a", r"begins with \+"), ("file f\nwords", "belongs to no fault"),
                          ("file f\n? twice\n- a += 1;\n+", "more than once"), ("file f\n? a part\n- 1;\n+ 2;", "not the whole"), ("file f\n? gone\n- b += 1;\n+", "has no"),
                          ("file f\n? overlap\n@ twice\n- a += 1; return a\n+ a\n? other\n@ twice\n- a * 2\n+ b", "overlaps")]:
            with self.assertRaisesRegex(faults.BadFault, why):
                faults.schemata(SOURCE, faults.parse(data, "box"))


if __name__ == "__main__":
    unittest.main()

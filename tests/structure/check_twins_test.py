#!/usr/bin/env python3
"""check_twins.py finds what is defined twice, and nothing else.

usage: check_twins_test.py [unittest options]
"""

import pathlib
import tempfile
import unittest

import check_twins


class CheckTwins(unittest.TestCase):
    def problems(self, first, second):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "src")
            source.mkdir()
            (source / "first.hpp").write_text("namespace mesh {\n" + first + "\n}\n")
            (source / "second.cpp").write_text("namespace mesh {\n" + second + "\n}\n")
            return check_twins.problems(folder)[0]

    def test_finds_two_functions_of_one_signature(self):
        inline = "inline double angle_at(const Point& a, const Point& b) { return a.x < b.x ? 1 : 2; }"
        found = self.problems(inline, "double angle_at(const Point& p,\n  const Point& q) {\n  return 3;\n}")
        self.assertEqual(len(found), 1)
        self.assertIn("mesh::angle_at(constPoint&,constPoint&)", found[0])
        self.assertIn("src/first.hpp and src/second.cpp", found[0])

    def test_finds_two_types_of_one_name(self):
        self.assertEqual(len(self.problems("enum class Start { kNow };", "struct Start {\n  int at;\n};")), 1)
        self.assertEqual(len(self.problems("class Start final : public Base { int at; };", "struct Start { int at; };")), 1)

    def test_leaves_overloads_methods_and_what_is_unnamed(self):
        self.assertEqual(self.problems("inline int f(int a) { return a; }", "int f(double a) { return 1; }"), [])
        self.assertEqual(self.problems("struct A { int f() { return 1; } };", "struct B { int f() { return 2; } };"), [])
        self.assertEqual(self.problems("namespace other { inline int f() { return 1; } }", "int f() { return 2; }"), [])
        self.assertEqual(self.problems("inline int f() { return 1; }", "namespace { int f() { return 2; } }"), [])
        self.assertEqual(self.problems("struct A { struct Part; };", "struct A::Part { int a; };\nint A::f() { return 1; }"), [])
        self.assertEqual(self.problems("struct A;\nint f();", "struct A { int a; };\nint f() { return 1; }"), [])

    def test_leaves_what_stands_in_for_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "src")
            source.mkdir()
            for name, twins in (("first_without_that.cpp", 0), ("second.cpp", 1)):
                (source / "first.cpp").write_text("int f() { return 1; }\n")
                (source / name).write_text("int f() { return 2; }\n")
                self.assertEqual(len(check_twins.problems(folder)[0]), twins)

    def test_leaves_functions_that_take_functions(self):
        self.assertEqual(self.problems("std::function<void(int)> f() { return {}; }", "std::function<void(int)> g() { return {}; }"), [])


if __name__ == "__main__":
    unittest.main()

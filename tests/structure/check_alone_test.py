#!/usr/bin/env python3
"""check_alone.py finds the files that miss an include, and passes the others."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).with_name("check_alone.py")


class CheckAlone(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        self.write("src/one/CMakeLists.txt", "driftmesh_library(one SOURCES a.cpp b.cpp)")
        self.write("src/one/one.hpp", "#pragma once\n#include <string>\ninline std::string one() { return GREETING; }\n")
        self.write("src/one/a.cpp", '#include "one/one.hpp"\nstd::string a() { return one(); }\n')
        command = f"ccache c++ -I{self.root}/src '-DGREETING=\"good day\"' -o src/one/CMakeFiles/dm_one.dir/a.o -c a.cpp"
        self.write("compile_commands.json", json.dumps([{"file": f"{self.root}/src/one/a.cpp", "command": command}]))

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def check(self, *options):
        return subprocess.run([sys.executable, CHECK, *options, self.root, self.root], capture_output=True, text=True, check=False)

    def test_whole_files(self):
        result = self.check("--sources")
        self.assertEqual((result.returncode, result.stdout), (0, "2 files, 0 of which do not compile alone\n"))

    def test_header_that_lacks_an_include(self):
        self.write("src/one/two.hpp", "#pragma once\ninline std::string two() { return {}; }\n")
        result = self.check()
        self.assertEqual(result.returncode, 1)
        self.assertIn("src/one/two.hpp does not compile alone", result.stdout)
        self.assertIn("2 files, 1 of which", result.stdout)

    def test_header_that_gets_what_it_lacks_where_it_is_included(self):
        self.write("src/one/two.hpp", "#pragma once\ninline std::string two() { return {}; }\n")
        self.write("src/one/three.hpp", '#pragma once\n#include "one/one.hpp"\n#include "one/two.hpp"\n')
        result = self.check()
        self.assertEqual(result.returncode, 1)
        self.assertIn("src/one/two.hpp does not compile alone", result.stdout)

    def test_headers_that_include_each_other_in_a_row(self):
        self.write("src/one/two.hpp", '#pragma once\n#include "one/one.hpp"\ninline std::string two() { return one(); }\n')
        self.write("src/one/three.hpp", '#pragma once\n#include "one/two.hpp"\ninline auto three() { return two(); }\n')
        self.assertEqual(self.check().stdout, "3 files, 0 of which do not compile alone\n")
        self.write("src/one/three.hpp", '#pragma once\n#include "one/two.hpp"\ninline auto three() { return four(); }\n')
        result = self.check()
        self.assertIn("src/one/three.hpp does not compile alone", result.stdout)
        self.assertIn("3 files, 1 of which", result.stdout)

    def test_header_that_includes_what_it_needs_too_late(self):
        self.write("src/one/two.hpp", '#pragma once\ninline std::string two();\n#include "one/one.hpp"\n')
        self.assertIn("src/one/two.hpp does not compile alone", self.check().stdout)

    def test_header_without_a_guard(self):
        self.write("src/one/two.hpp", "inline int two() { return 2; }\n")
        self.assertIn("src/one/two.hpp does not compile alone", self.check().stdout)

    def test_source_that_lacks_an_include(self):
        self.write("src/one/b.cpp", "std::string b() { return one(); }\n")
        self.assertEqual(self.check().returncode, 0)
        self.assertIn("src/one/b.cpp does not compile alone", self.check("--sources").stdout)

    def test_source_with_flags_of_its_own(self):
        self.write("src/one/b.cpp", "const char* b() { return PARTING; }\n")
        self.assertIn("src/one/b.cpp does not compile alone", self.check("--sources").stdout)
        entries = json.loads((self.root / "compile_commands.json").read_text())
        entries.append({"file": f"{self.root}/src/one/b.cpp", "command": "c++ '-DPARTING=\"good night\"' -o b.o -c b.cpp"})
        self.write("compile_commands.json", json.dumps(entries))
        self.assertEqual(self.check("--sources").returncode, 0)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""check_includes.py accepts a sound tree and finds each kind of mistake in a broken one."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).with_name("check_includes.py")


class CheckIncludes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("src/low/CMakeLists.txt", "driftmesh_library(low SOURCES low.cpp)")
        self.write("src/low/low.hpp", "#pragma once\n")
        self.write("src/middle/CMakeLists.txt", "# a remark (with brackets)\ndriftmesh_library(middle SOURCES DEPENDS low)")
        self.write("src/middle/middle.hpp", '#include <vector>\n#include "low/low.hpp"\n')
        self.write("src/high/CMakeLists.txt", "driftmesh_library(high SOURCES high.cpp DEPENDS middle LIBS low)")
        self.write("src/high/high.hpp", '#include "middle/middle.hpp"\n')
        self.write("src/high/high.cpp", '#include "high/high.hpp"\n')

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def check(self):
        return subprocess.run([sys.executable, CHECK, self.root], capture_output=True, text=True, check=False)

    def expect(self, message):
        result = self.check()
        self.assertEqual(result.returncode, 1)
        self.assertIn(message, result.stdout)

    def test_sound_tree(self):
        result = self.check()
        self.assertEqual((result.returncode, result.stdout), (0, "3 boxes, 0 problems\n"))

    def test_upward_include(self):
        self.write("src/low/low.cpp", '\n#include "high/high.hpp"\n')
        self.expect("src/low/low.cpp:2: includes high/high.hpp")

    def test_include_of_an_indirect_dependency(self):
        self.write("src/high/high.cpp", '#include "low/low.hpp"\n')
        self.expect("src/high/high.cpp:1: includes low/low.hpp")

    def test_cycle(self):
        self.write("src/low/CMakeLists.txt", "driftmesh_library(low DEPENDS high)")
        self.expect("cycle: ")

    def test_unknown_box(self):
        self.write("src/low/CMakeLists.txt", "driftmesh_library(low DEPENDS lower)")
        self.expect("low: depends on lower")

    def test_missing_header(self):
        self.write("src/low/low.cpp", '#include "low/gone.hpp"\n')
        self.expect("src/low/low.cpp:1: low/gone.hpp is not found")

    def test_folder_without_a_box(self):
        self.write("src/stray/stray.cpp", "")
        self.expect("src/stray: no driftmesh_library")

    def test_library_outside_its_place(self):
        self.write("src/low/low.cpp", "#include <mpi.h>\n")
        self.expect("src/low/low.cpp:1: includes mpi.h, which belongs to protocol/mpi/mpi_transport.cpp")

    def test_library_in_its_place(self):
        self.write("src/picture/CMakeLists.txt", "driftmesh_library(picture)")
        self.write("src/picture/plot_canvas.cpp", "#include <cairo.h>\n")
        self.assertEqual(self.check().returncode, 0)

    def test_empty_tree(self):
        with tempfile.TemporaryDirectory() as empty:
            self.root = pathlib.Path(empty)
            self.assertEqual(self.check().returncode, 1)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""check_includes.py accepts the project as it is, and finds each kind of mistake in a copy of it."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).with_name("check_includes.py")
PROJECT = CHECK.parents[2]
sys.path.insert(0, str(CHECK.parent))

from boxes import TOPS, declared_boxes  # pylint: disable=wrong-import-position

PAGE = "docs/architecture.md"


class BrokenProject(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for top in TOPS:
            shutil.copytree(PROJECT / top, self.root / top)
        (self.root / "docs").mkdir()
        shutil.copy(PROJECT / PAGE, self.root / PAGE)

    def run_check(self, *options):
        return subprocess.run([sys.executable, CHECK, *options, self.root], capture_output=True, text=True, check=False)

    def expect(self, *messages):
        result = self.run_check()
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        for message in messages:
            self.assertIn(message, result.stdout)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def include(self, name, header):
        """Makes a file include a header, in its first line."""
        mark = header if header[0] in '<"' else f'"{header}"'
        self.write(name, f"#include {mark}\n" + (self.root / name).read_text())

    def declare(self, box, section, word, only=False):
        """Adds a word to a section of the declaration of a box, or makes it the only one there."""
        folder = next(other.folder for other in declared_boxes(self.root) if other.name == box)
        path = folder / "CMakeLists.txt"
        text = path.read_text()
        if section not in text:
            text = re.sub(rf"(driftmesh_library\(\s*{box}\b[^)]*)\)", rf"\1 {section})", text)
        after = r"\b[^)A-Z]*" if only else r"\b"
        text, count = re.subn(rf"(driftmesh_library\(\s*{box}\b[^)]*{section}){after}", rf"\1 {word} ", text)
        self.assertEqual(count, 1)
        path.write_text(text)

    def undeclare(self, box, word):
        folder = next(other.folder for other in declared_boxes(self.root) if other.name == box)
        text, count = re.subn(rf"\b{word}\b(?!\.)", "", (folder / "CMakeLists.txt").read_text().split("driftmesh_library", 1)[1])
        self.assertEqual(count, 1)
        (folder / "CMakeLists.txt").write_text("driftmesh_library" + text)

    # The project itself.

    def test_the_project_is_sound(self):
        result = self.run_check()
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertRegex(result.stdout, r"^\d\d boxes, 0 problems\n$")

    def test_an_empty_project_is_not(self):
        for top in TOPS:
            shutil.rmtree(self.root / top)
        self.expect("0 boxes")

    # Headers of other boxes.

    def test_transport_in_the_mesher(self):
        self.include("src/mesh/cavity.cpp", "protocol/mpi/mpi_transport.hpp")
        self.expect("src/mesh/cavity.cpp:1: includes protocol/mpi/mpi_transport.hpp (transport_mpi), which the DEPENDS of mesh")

    def test_messages_in_the_mesher(self):
        self.include("src/mesh/cavity.hpp", "protocol/messages.hpp")
        self.expect("src/mesh/cavity.hpp:1: includes protocol/messages.hpp (protocol), which the DEPENDS of mesh",
                    "reaches src/mesh/refiner.hpp -> src/mesh/improver.hpp -> src/mesh/cavity.hpp -> protocol/messages.hpp, which mesh does not stand on")

    def test_messages_in_the_mesher_by_way_of_a_box_below(self):
        self.include("src/base/narrow.hpp", "protocol/messages.hpp")
        self.expect("reaches src/base/narrow.hpp -> protocol/messages.hpp, which mesh does not stand on")

    def test_messages_in_the_mesher_by_other_names(self):
        for header in ("<protocol/messages.hpp>", "../../protocol/messages.hpp", "mesh/../../protocol/messages.hpp"):
            with self.subTest(header):
                self.include("src/mesh/cavity.cpp", header)
                self.expect("src/mesh/cavity.cpp:1: includes " + header.strip("<>"), "(protocol), which the DEPENDS of mesh")

    def test_messages_in_the_mesher_by_way_of_a_file_outside_all_boxes(self):
        self.write("tests/support/way.inc", '#include "protocol/messages.hpp"\n')
        self.include("src/mesh/cavity.cpp", "tests/support/way.inc")
        self.expect("src/mesh/cavity.cpp:1: includes tests/support/way.inc (no box)",
                    "src/mesh/cavity.cpp: reaches tests/support/way.inc -> protocol/messages.hpp")

    def test_messages_in_the_mesher_by_a_macro(self):
        self.write("src/mesh/cavity.cpp", '#define WAY "protocol/messages.hpp"\n#include WAY\n')
        self.expect("src/mesh/cavity.cpp:2: includes WAY")

    def test_messages_in_the_mesher_declared(self):
        self.include("src/mesh/cavity.cpp", "protocol/messages.hpp")
        self.declare("mesh", "DEPENDS", "protocol")
        self.expect("mesh: stands on protocol, from which it is kept apart")

    def test_messages_in_the_mesher_declared_by_a_box_below(self):
        self.include("src/sizing/gradation.cpp", "protocol/messages.hpp")
        self.declare("sizing", "DEPENDS", "protocol")
        self.expect("mesh: stands on protocol, from which it is kept apart")

    def test_communicator_in_a_policy(self):
        self.include("balancer/policies/policy_greedy.cpp", "protocol/mpi/mpi_transport.hpp")
        self.expect("balancer/policies/policy_greedy.cpp:1: includes protocol/mpi/mpi_transport.hpp (transport_mpi)")

    def test_controller_in_a_policy(self):
        self.include("balancer/policies/policy_greedy.cpp", "balancer/controller.hpp")
        self.declare("policies", "DEPENDS", "balancer")
        self.expect("policies: stands on balancer, from which it is kept apart")

    def test_planner_in_the_trigger(self):
        self.include("balancer/trigger/outlook.cpp", "balancer/planner/surplus.hpp")
        self.expect("balancer/trigger/outlook.cpp:1: includes balancer/planner/surplus.hpp (balancer_planner)")

    def test_source_of_another_folder(self):
        self.declare("mesh", "SOURCES", "../../protocol/codec.cpp")
        self.expect("src/mesh: mesh has ../../protocol/codec.cpp, which lies in another folder")

    def test_link_around_the_declaration(self):
        for call in ("target_link_libraries(dm_mesh PRIVATE dm_protocol)", "include_directories(/)"):
            with self.subTest(call):
                self.write("src/mesh/CMakeLists.txt", (PROJECT / "src/mesh/CMakeLists.txt").read_text() + call)
                self.expect("src/mesh/CMakeLists.txt: " + call[:19])

    # Outside libraries.

    def test_library_in_the_mesher(self):
        for header, lib in (("fmt/format.h", "fmt"), ("nlohmann/json.hpp", "json"), ("mpi.h", "mpi")):
            with self.subTest(header):
                self.include("src/mesh/cavity.cpp", f"<{header}>")
                self.expect(f"src/mesh/cavity.cpp: reaches {header}, and the LIBS of mesh does not name {lib}")

    def test_library_in_the_mesher_by_way_of_a_box_below(self):
        self.include("src/base/narrow.hpp", "<fmt/format.h>")
        self.declare("base", "LIBS", "fmt")
        self.expect("reaches src/base/narrow.hpp -> fmt/format.h, and the LIBS of mesh does not name fmt")

    def test_library_in_a_box_that_must_not_have_it(self):
        self.include("src/cluster/cluster_run.cpp", "<mpi.h>")
        self.declare("cluster", "LIBS", "mpi")
        self.expect("cluster: must not use mpi, which belongs to api_mpi and partition_zoltan and public_mpi and python_ranks and transport_mpi")

    def test_unknown_library(self):
        for header in ("<CGAL/Bbox_2.h>", "<boost/multiprecision/cpp_int.hpp>", "<omp.h>", "gone.hpp"):
            with self.subTest(header):
                self.include("src/mesh/cavity.cpp", header)
                self.expect(f"src/mesh/cavity.cpp:1: includes {header.strip('<>')}, which is neither of this project nor")
        self.declare("mesh", "LIBS", "openmp")
        self.expect("mesh: must not use openmp, which belongs to no box")

    def test_unused_library(self):
        self.declare("mesh", "LIBS", "fmt")
        self.expect("mesh: names fmt in LIBS and includes nothing of it")

    # Declarations.

    def test_unused_dependency(self):
        self.declare("cluster", "DEPENDS", "picture")
        self.expect("cluster: depends on picture and includes nothing of it")

    def test_missing_dependency(self):
        self.undeclare("verify", "geometry")
        self.expect("(geometry), which the DEPENDS of verify does not name")

    def test_unknown_dependency(self):
        self.declare("mesh", "DEPENDS", "meshes")
        self.expect("mesh: depends on meshes, which no driftmesh_library declares")

    def test_cycle(self):
        self.declare("base", "DEPENDS", "mesh")
        self.expect("cycle: ")

    def test_two_boxes_in_one_folder(self):
        path = "src/mesh/CMakeLists.txt"
        self.write(path, (self.root / path).read_text() + "driftmesh_library(mesher DEPENDS protocol)\n")
        self.expect("src/mesh: mesher is not the one box of one folder")

    def test_folder_without_a_box(self):
        self.write("src/mesh/detail/stray.cpp", "")
        self.expect("src/mesh/detail: no driftmesh_library declares this folder")

    # The graph in the documentation.

    def test_outdated_graph(self):
        self.include("src/cluster/cluster_run.cpp", "picture/plot.hpp")
        self.declare("cluster", "DEPENDS", "picture")
        self.expect(f"{PAGE}: shows another graph")
        self.assertEqual(self.run_check("--update").returncode, 0)
        self.assertEqual(self.run_check().stdout.count("problems"), 1)
        self.assertEqual(self.run_check().returncode, 0)
        self.assertIn(self.run_check("--graph").stdout, (self.root / PAGE).read_text())

    def test_page_without_a_graph(self):
        self.write(PAGE, (self.root / PAGE).read_text().replace("--graph", ""))
        self.expect(f"{PAGE}: shows another graph")

    def test_graph_names_the_nearest_boxes_alone(self):
        lines = self.run_check("--graph").stdout.splitlines()
        self.assertIn("dyadic", lines)
        self.assertTrue(any(re.fullmatch(r"mesh +-> dyadic sizing", line) for line in lines), lines)


if __name__ == "__main__":
    unittest.main()

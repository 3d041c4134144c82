#!/usr/bin/env python3
"""The product as a user gets it: installed, moved elsewhere, and built against from outside the tree.

usage: install_test.py SOURCE_FOLDER BUILD_FOLDER VERSION COMPILER GENERATOR MPIEXEC
"""

import pathlib
import re
import shutil
import sys
import tempfile
import unittest

from command import run

SOURCE, BUILD, VERSION, COMPILER, GENERATOR, MPIEXEC = sys.argv[1:7]
EXAMPLES = pathlib.Path(SOURCE) / "examples"
WARNINGS = "-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -DOMPI_SKIP_MPICXX"


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.scratch = pathlib.Path(folder.name)
        first = cls.scratch / "first"
        run("cmake", "--install", BUILD, "--prefix", first)
        cls.prefix = cls.scratch / "moved"
        first.rename(cls.prefix)
        cls.libdir = next(cls.prefix.rglob("driftmesh.pc")).parent.parent

    def build(self, project, *options):
        """The folder in which a project of the examples was built, in a copy outside the tree."""
        source = self.scratch / f"{self.id()}.source"
        shutil.copytree(EXAMPLES / project, source)
        build = self.scratch / f"{self.id()}.build"
        run("cmake", "-G", GENERATOR, "-S", source, "-B", build, f"-DCMAKE_CXX_COMPILER={COMPILER}",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_FLAGS={WARNINGS}", "-DCMAKE_BUILD_TYPE=Release", *options)
        run("cmake", "--build", build)
        return build

    def test_files_name_no_path_of_the_machine(self):
        paths = [path.encode() for path in (SOURCE, BUILD, str(self.scratch))]
        for file in (f for f in self.prefix.rglob("*") if f.is_file()):
            content = file.read_bytes()
            for path in paths:
                self.assertNotIn(path, content, f"{file} names {path.decode()}")

    def test_program(self):
        program = self.prefix / "bin" / "driftmesh"
        self.assertIn(VERSION, run(program, "--version"))
        for page in ("man/man1/driftmesh.1", "bash-completion/completions/driftmesh", "zsh/site-functions/_driftmesh",
                     "fish/vendor_completions.d/driftmesh.fish", "driftmesh/configs/first-run.yaml",
                     "doc/driftmesh/LICENSE"):
            self.assertTrue((self.prefix / "share" / page).is_file(), page)
        run(program, "generate", "fan", "-o", "fan.poly", cwd=self.scratch)
        run(program, "mesh", "fan.poly", "-o", "fan.vtu", cwd=self.scratch)
        run(program, "check", "fan.vtu", "fan.poly", cwd=self.scratch)

    def test_serial_consumer_knows_nothing_of_mpi(self):
        build = self.build("first_mesh", "-DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_Zoltan=ON")
        run("./first_mesh", cwd=build)
        run(self.prefix / "bin" / "driftmesh", "check", build / "square.vtu")
        self.assertNotRegex(run("ldd", build / "first_mesh"), "libmpi|zoltan|cairo|yaml")

    def test_consumer_in_c(self):
        if not list(self.libdir.glob("libdriftmesh_triangle.so*")):
            self.skipTest("this build has no library for C")
        build = self.build("triangle_c")
        self.assertIn("area 0.96", run("./triangle_c", cwd=build))
        self.assertNotRegex(run("ldd", build / "triangle_c"), "libmpi|zoltan|cairo|yaml")

    def test_distributed_consumer(self):
        build = self.build("laplace")
        said = run(MPIEXEC, "-n", 2, build / "laplace", "1e-3")
        self.assertIn("on 2 ranks", said)
        self.assertNotRegex(run("ldd", build / "laplace"), "cairo|yaml")

    def test_pictures(self):
        source = self.scratch / "pictures"
        source.mkdir()
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES CXX)\n"
            "find_package(driftmesh REQUIRED COMPONENTS pictures)\nadd_executable(p p.cpp)\n"
            "target_link_libraries(p PRIVATE driftmesh::pictures)\n")
        (source / "p.cpp").write_text(
            "#include <driftmesh/generate.hpp>\n#include <driftmesh/mesher.hpp>\n#include <driftmesh/plot.hpp>\n"
            'int main() { driftmesh::plot(driftmesh::mesh(driftmesh::generate("fan")), "fan.png"); }\n')
        run("cmake", "-G", GENERATOR, "-S", source, "-B", source / "build", f"-DCMAKE_CXX_COMPILER={COMPILER}",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_FLAGS={WARNINGS}")
        run("cmake", "--build", source / "build")
        run("./p", cwd=source / "build")
        self.assertTrue((source / "build" / "fan.png").read_bytes().startswith(b"\x89PNG"))
        self.assertNotRegex(run("ldd", source / "build" / "p"), "libmpi|zoltan|yaml")

    def test_all_examples_at_once(self):
        self.build(".")

    def test_pkg_config(self):
        program = self.scratch / "by_pkg_config"
        flags = run("env", f"PKG_CONFIG_PATH={self.libdir}/pkgconfig", "pkg-config", "--cflags", "--libs", "driftmesh").split()
        run(COMPILER, "-std=c++20", EXAMPLES / "first_mesh" / "first_mesh.cpp", "-o", program, *flags)
        run("env", f"LD_LIBRARY_PATH={self.libdir}", program, cwd=self.scratch)

    def test_pkg_config_distributed(self):
        program = self.scratch / "by_pkg_config_distributed"
        flags = run("env", f"PKG_CONFIG_PATH={self.libdir}/pkgconfig", "pkg-config", "--cflags", "--libs",
                    "driftmesh-distributed").split()
        run("env", f"OMPI_CXX={COMPILER}", "mpicxx", "-std=c++20", EXAMPLES / "laplace" / "laplace.cpp", "-o", program, *flags)
        run("env", f"LD_LIBRARY_PATH={self.libdir}", MPIEXEC, "-n", 2, program, "1e-3")

    def test_version_of_the_package(self):
        """What is older or too new is refused."""
        major, minor, _ = (int(part) for part in VERSION.split("."))
        for wanted, found in ((f"{major}.{minor}", True), (VERSION, True), (f"{major}.{minor + 1}", False),
                              (f"{major + 1}", False), ("0.1", False)):
            source = self.scratch / f"version-{wanted}"
            source.mkdir()
            (source / "CMakeLists.txt").write_text(
                "cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES CXX)\n"
                f"find_package(driftmesh {wanted} QUIET)\nmessage(STATUS \"found: ${{driftmesh_FOUND}}\")\n")
            said = run("cmake", "-G", GENERATOR, "-S", source, "-B", source / "build", f"-DCMAKE_CXX_COMPILER={COMPILER}",
                       f"-DCMAKE_PREFIX_PATH={self.prefix}")
            self.assertEqual(re.search("found: (.*)", said)[1] in ("1", "TRUE"), found, wanted)

    def test_headers_compile_alone(self):
        """With warnings as errors, and with no include root but the installed one."""
        include = self.prefix / "include"
        headers = sorted(include.rglob("*.hpp"))
        self.assertGreater(len(headers), 10)
        for header in headers:
            name = header.relative_to(include)
            compiler = "mpicxx" if "mpi.h" in header.read_text() else COMPILER
            run(compiler, "-std=c++20", *WARNINGS.split(), f"-I{include}", "-include", header, "-fsyntax-only", "-x", "c++",
                "/dev/null")
            for included in re.findall(r'#include ["<](.*)[">]', header.read_text()):
                self.assertTrue(included.startswith("driftmesh/") or "/" not in included, f"{name} includes {included}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
